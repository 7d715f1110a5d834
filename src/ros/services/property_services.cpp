#include "services/property_services.h"

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/named_parts.h"
#include "messages/conversions.h"
#include "messages/physics_message.h"
#include "services/door/reference_frame.h"

namespace blem_sim::node {

namespace {

/** The one value of a list; `otherwise` if the list is empty. */
double valueOr(const std::vector<double>& values, double otherwise, const char* field) {
  if (values.size() > 1)
    throw InputError(std::string(field) + ": has " + std::to_string(values.size()) + " values; joints here have one axis");
  return values.empty() ? otherwise : values.front();
}

/** Names of the lists that are given and mean nothing here. */
std::string meaningless(const ODEJointProperties& given) {
  std::string names;
  const auto look = [&](const char* name, const std::vector<double>& values) {
    if (!values.empty()) names += std::string(" ") + name;
  };
  look("erp", given.erp), look("cfm", given.cfm), look("stop_erp", given.stop_erp), look("stop_cfm", given.stop_cfm);
  look("fudge_factor", given.fudge_factor), look("fmax", given.fmax), look("vel", given.vel);
  return names;
}

geometry::MassProperties requestedInertial(const SetLinkProperties::Request& request) {
  const Pose X_LI = fromPose(request.com, "com");
  Matrix3 inertia;
  inertia << request.ixx, request.ixy, request.ixz, request.ixy, request.iyy, request.iyz, request.ixz, request.iyz, request.izz;
  return {request.mass, X_LI.translation(), X_LI.linear() * inertia * X_LI.linear().transpose()};
}

}  // namespace

PropertyServices::PropertyServices(const ros::NodeHandle& private_node, SimulationLoop* loop) : loop_(loop), services_(private_node) {
  services_.add<SetPhysicsProperties>("set_physics_properties",
                                      [this](const auto& request, auto* response) { setPhysics(request, response); });
  services_.add<SetLinkProperties>("set_link_properties", [this](const auto& request, auto*) { setLink(request); });
  services_.add<SetJointProperties>("set_joint_properties", [this](const auto& request, auto* response) { setJoint(request, response); });
}

void PropertyServices::setPhysics(const SetPhysicsProperties::Request& request, SetPhysicsProperties::Response* response) {
  sim::Simulator& simulator = loop_->simulator();
  const std::string differences = differencesIn(request.ode_config, simulator.config());
  simulator.setPhysics(fromVector3(request.gravity), request.time_step, request.max_update_rate * request.time_step);
  loop_->paceChanged();
  if (!differences.empty())
    response->status_message =
        "gravity, time_step and max_update_rate are set; of ode_config the configuration's values hold:" + differences;
}

void PropertyServices::setLink(const SetLinkProperties::Request& request) {
  const sim::LinkPart part = sim::findLink(loop_->simulator(), request.link_name, "link_name");
  if (part.body == dynamics::WORLD_BODY) throw InputError("link_name: '" + part.name + "' is fixed to the world; its mass means nothing");
  const geometry::MassProperties inertial = requestedInertial(request);
  if (!(inertial.mass > 0) || !inertial.inertia.allFinite() || !inertial.com.allFinite() || inertial.inertia.llt().info() != Eigen::Success)
    throw InputError("mass, com, ixx to izz: need a finite mass above 0 and a positive definite inertia");
  loop_->simulator().setLinkInertial(part.body, part.link, inertial);
  loop_->simulator().setLinkGravity(part.body, part.link, request.gravity_mode);
}

void PropertyServices::setJoint(const SetJointProperties::Request& request, SetJointProperties::Response* response) {
  sim::Simulator& simulator = loop_->simulator();
  const ODEJointProperties& given = request.ode_joint_config;
  const sim::JointPart part = sim::findJoint(simulator, request.joint_name, "joint_name");
  const sim::RobotInfo& robot = simulator.robots()[part.robot];
  const model::JointLimits& limits = robot.limits[part.joint];
  const double present = simulator.jointDamping(robot.joints[part.joint]), damping = valueOr(given.damping, present, "damping");
  const double lower = valueOr(given.loStop, limits.lower, "loStop"), upper = valueOr(given.hiStop, limits.upper, "hiStop");
  simulator.setJointDamping(part.robot, part.joint, damping);
  try {
    if (!given.loStop.empty() || !given.hiStop.empty()) simulator.setJointLimits(part.robot, part.joint, lower, upper);
  } catch (const InputError&) {
    simulator.setJointDamping(part.robot, part.joint, present);
    throw;
  }
  const std::string others = meaningless(given);
  if (!others.empty()) response->status_message = "damping and limits are taken; these mean nothing here:" + others;
}

}  // namespace blem_sim::node
