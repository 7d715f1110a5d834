#include "blem_sim/geometry/input_error.h"
#include "sensors/sensor.h"

namespace blem_sim::sim {
namespace {

/** The wrench that a joint carries, about the origin of the child's link frame, where the joint sits. */
class ForceTorqueSensor : public Sensor {
 public:
  ForceTorqueSensor(const SimulatedWorld& world, const SensorInfo& info) : info_(info), robot_(world.robots[info.robot]) {
    const model::JointModel& joint = robot_.description->joints[robot_.description->jointIndex(info.config.joint)];
    parent_link_ = joint.parent;
    child_link_ = joint.child;
    X_PJ_ = joint.X_PJ;
    for (std::size_t j = 0; j < robot_.lumped->joints.size(); ++j)
      if (robot_.lumped->joints[j].name == info.config.joint) world_joint_ = robot_.world_joints[j];
    sign_ = info.config.measure == "child_to_parent" ? -1 : 1;
  }

  void measure(const StepContext& step, SensorReading* out) override {
    const Wrench& about_joint = step.joint_wrenches[world_joint_];
    // Newton-Euler's configuration is that at the start of the step.
    const Pose X_WP = step.world.linkPose(robot_, parent_link_, step.bodies_before);
    const Pose X_WJ = X_WP * X_PJ_;
    const Pose X_WC = step.world.linkPose(robot_, child_link_, step.bodies_before);
    const Vector3 torque = about_joint.torque + (X_WJ.translation() - X_WC.translation()).cross(about_joint.force);
    const Matrix3 R_WA = info_.config.frame == "parent" ? X_WP.linear() : info_.config.frame == "sensor" ? X_WJ.linear() : X_WC.linear();
    ForceTorqueReading& reading = readingIn<ForceTorqueReading>(out);
    reading.force = sign_ * (R_WA.transpose() * about_joint.force);
    reading.torque = sign_ * (R_WA.transpose() * torque);
    reading.frame_id = info_.frame_id;
  }

 private:
  const SensorInfo info_;
  const RobotInfo robot_;
  int parent_link_ = 0, child_link_ = 0, world_joint_ = -1;
  Pose X_PJ_;
  double sign_ = 1;
};

}  // namespace

std::unique_ptr<Sensor> makeForceTorqueSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<ForceTorqueSensor>(world, info);
}

}  // namespace blem_sim::sim
