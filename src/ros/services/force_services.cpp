#include "services/force_services.h"

#include <blem_sim/BodyRequest.h>
#include <blem_sim/JointRequest.h>

#include "blem_sim/geometry/input_error.h"
#include "messages/conversions.h"
#include "services/door/reference_frame.h"

namespace blem_sim::node {

namespace {

template <typename Request>
sim::LoadTime timeOf(const Request& request) {
  return {request.start_time.toSec(), request.duration.toSec()};
}

}  // namespace

ForceServices::ForceServices(const ros::NodeHandle& private_node, sim::Simulator* simulator)
    : simulator_(simulator), services_(private_node) {
  services_.add<ApplyBodyWrench>("apply_body_wrench", [this](const auto& request, auto*) { applyWrench(request); });
  services_.add<ApplyJointEffort>("apply_joint_effort", [this](const auto& request, auto*) { applyEffort(request); });
  services_.add<BodyRequest>("clear_body_wrenches", [this](const auto& request, auto*) {
    simulator_->clearLoads(sim::findLink(*simulator_, request.body_name, "body_name").body);
  });
  services_.add<JointRequest>("clear_joint_forces", [this](const auto& request, auto*) {
    const sim::JointPart part = sim::findJoint(*simulator_, request.joint_name, "joint_name");
    simulator_->clearEfforts(simulator_->robots()[part.robot].joints[part.joint]);
  });
}

// As in Gazebo, a force in the world's frame at its origin pushes the body at its centre of mass: few users mean the origin.
void ForceServices::applyWrench(const ApplyBodyWrench::Request& request) {
  const sim::LinkPart part = sim::findLink(*simulator_, request.body_name, "body_name");
  if (part.body == dynamics::WORLD_BODY) throw InputError("body_name: '" + part.name + "' is fixed to the world; nothing moves it");
  const std::optional<sim::LinkPart> frame = sim::findFrame(*simulator_, request.reference_frame, "reference_frame");
  const Pose X_WF = frame ? partMotion(*simulator_, *frame).X_WL : Pose::Identity();
  const Vector3 point = fromPoint(request.reference_point);
  sim::BodyLoad load;
  load.body = part.body;
  load.wrench.force = X_WF.linear() * fromVector3(request.wrench.force);
  load.wrench.torque = X_WF.linear() * fromVector3(request.wrench.torque);
  load.p_B = simulator_->report().bodies[part.body].X_WB.inverse() * (X_WF * point);
  if (!frame && point.isZero(0)) load.p_B = simulator_->world().bodySpec(part.body).inertial.com;
  simulator_->applyLoad(load, timeOf(request));
}

void ForceServices::applyEffort(const ApplyJointEffort::Request& request) {
  const sim::JointPart part = sim::findJoint(*simulator_, request.joint_name, "joint_name");
  simulator_->applyEffort(simulator_->robots()[part.robot].joints[part.joint], request.effort, timeOf(request));
}

}  // namespace blem_sim::node
