#include "blem_sim/geometry/input_error.h"
#include "sensors/types/sensor.h"

namespace blem_sim::sim {
namespace {

/** The wrench that a joint carries, in the axes of a frame and about its origin. */
class ForceTorqueSensor : public Sensor {
 public:
  ForceTorqueSensor(const SimulatedWorld& world, const SensorInfo& info) : info_(info), robot_(world.robots[info.robot]) {
    const model::JointModel& joint = robot_.description->joints[robot_.description->jointIndex(info.config.joint)];
    parent_link_ = joint.parent;
    frame_link_ = robot_.description->linkIndex(info.config.link);
    X_PJ_ = joint.X_PJ;
    for (std::size_t j = 0; j < robot_.lumped->joints.size(); ++j)
      if (robot_.lumped->joints[j].name == info.config.joint) world_joint_ = robot_.world_joints[j];
    sign_ = info.config.measure == "child_to_parent" ? -1 : 1;
  }

  void measure(const StepContext& step, SensorReading* out) override {
    const Wrench& about_joint = step.joint_wrenches[world_joint_];
    // Newton-Euler's configuration is that at the start of the step.
    const Pose X_WJ = step.world.linkPose(robot_, parent_link_, step.bodies_before) * X_PJ_;
    const Pose X_WA = step.world.linkPose(robot_, frame_link_, step.bodies_before) * info_.config.X_LS;
    const Vector3 torque = about_joint.torque + (X_WJ.translation() - X_WA.translation()).cross(about_joint.force);
    const Matrix3 R_AW = X_WA.linear().transpose();
    ForceTorqueReading& reading = readingIn<ForceTorqueReading>(out);
    reading.force = sign_ * (R_AW * about_joint.force);
    reading.torque = sign_ * (R_AW * torque);
    reading.frame_id = info_.frame_id;
  }

 private:
  const SensorInfo info_;
  const RobotInfo robot_;
  int parent_link_ = 0, frame_link_ = 0, world_joint_ = -1;
  Pose X_PJ_;
  double sign_ = 1;
};

}  // namespace

std::unique_ptr<Sensor> makeForceTorqueSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<ForceTorqueSensor>(world, info);
}

}  // namespace blem_sim::sim
