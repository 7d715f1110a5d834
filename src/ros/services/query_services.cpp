#include "services/query_services.h"

#include <blem_sim/GetJointProperties.h>
#include <blem_sim/GetLinkProperties.h>
#include <blem_sim/GetLinkState.h>
#include <blem_sim/GetModelProperties.h>
#include <blem_sim/GetModelState.h>
#include <blem_sim/GetPhysicsProperties.h>
#include <blem_sim/GetWorldProperties.h>

#include "messages/conversions.h"
#include "messages/physics_message.h"
#include "services/door/reference_frame.h"

namespace blem_sim::node {

namespace {

std::string frameName(const std::string& given) { return given.empty() ? WORLD_FRAME : given; }

void describeModel(const sim::Simulator& simulator, int index, GetModelProperties::Response* response) {
  const sim::ModelInfo& model = simulator.models()[index];
  for (const sim::LinkPart& part : sim::linksOf(simulator, index)) response->body_names.push_back(sim::withoutModel(part.name));
  response->canonical_body_name = response->body_names.front();
  for (const contact::Collider& collider : simulator.colliders())
    if (collider.enabled && collider.model == index) response->geom_names.push_back(sim::withoutModel(collider.name));
  const int robot = simulator.robotIndex(model.name);
  if (robot >= 0) response->joint_names = simulator.robots()[robot].joint_names;
  response->is_static = model.kind == sim::ModelKind::ENVIRONMENT;
}

std::uint8_t typeOf(const sim::Simulator& simulator, const sim::RobotInfo& robot, const std::string& name) {
  for (const model::LumpedJoint& joint : robot.lumped->joints) {
    if (joint.name != name) continue;
    if (joint.type == model::JointType::PRISMATIC) return GetJointProperties::Response::PRISMATIC;
    if (joint.type == model::JointType::CONTINUOUS) return GetJointProperties::Response::CONTINUOUS;
  }
  return GetJointProperties::Response::REVOLUTE;
}

geometry::MassProperties inertialOf(const sim::Simulator& simulator, const sim::LinkPart& part) {
  if (part.body != dynamics::WORLD_BODY) return simulator.linkInertial(part.body, part.link);
  if (part.robot < 0) return {};
  return simulator.robots()[part.robot].description->links[part.link].inertial.value_or(geometry::MassProperties());
}

}  // namespace

QueryServices::QueryServices(const ros::NodeHandle& private_node, SimulationLoop* loop) : services_(private_node) {
  const sim::Simulator& simulator = loop->simulator();
  addModels(simulator);
  addLinks(simulator);
  addJoints(simulator);
  services_.add<GetWorldProperties>("get_world_properties", [&simulator](const auto&, auto* response) {
    response->sim_time = simulator.time();
    for (const sim::ModelInfo& model : simulator.models())
      if (model.alive) response->model_names.push_back(model.name);
  });
  services_.add<GetPhysicsProperties>("get_physics_properties", [loop](const auto&, auto* response) {
    const sim::SimulationConfig& config = loop->simulator().config();
    response->time_step = config.time_step;
    response->pause = loop->paused();
    response->max_update_rate = config.real_time_factor / config.time_step;
    response->gravity = toVector3(loop->simulator().gravity());
    response->ode_config = toOdePhysics(config);
  });
}

void QueryServices::addModels(const sim::Simulator& simulator) {
  services_.add<GetModelProperties>("get_model_properties", [&simulator](const auto& request, auto* response) {
    describeModel(simulator, sim::findModel(simulator, request.model_name, "model_name"), response);
  });
  services_.add<GetModelState>("get_model_state", [&simulator](const auto& request, auto* response) {
    const int model = sim::findModel(simulator, request.model_name, "model_name");
    const sim::LinkMotion frame = frameMotion(simulator, request.relative_entity_name, "relative_entity_name");
    const sim::LinkMotion motion = seenFrom(frame, modelMotion(simulator, simulator.report(), model));
    response->header.stamp = toStamp(simulator.time());
    response->header.frame_id = frameName(request.relative_entity_name);
    response->pose = toPose(motion.X_WL);
    response->twist = toTwist(motion.v_WL, motion.w_WL);
  });
}

void QueryServices::addLinks(const sim::Simulator& simulator) {
  services_.add<GetLinkState>("get_link_state", [&simulator](const auto& request, auto* response) {
    const sim::LinkPart part = sim::findLink(simulator, request.link_name, "link_name");
    const sim::LinkMotion frame = frameMotion(simulator, request.reference_frame, "reference_frame");
    const sim::LinkMotion motion = seenFrom(frame, partMotion(simulator, part));
    response->link_state.link_name = request.link_name;
    response->link_state.reference_frame = frameName(request.reference_frame);
    response->link_state.pose = toPose(motion.X_WL);
    response->link_state.twist = toTwist(motion.v_WL, motion.w_WL);
  });
  services_.add<GetLinkProperties>("get_link_properties", [&simulator](const auto& request, auto* response) {
    const sim::LinkPart part = sim::findLink(simulator, request.link_name, "link_name");
    const geometry::MassProperties inertial = inertialOf(simulator, part);
    Pose X_LCom = Pose::Identity();
    X_LCom.translation() = inertial.com;
    response->com = toPose(X_LCom);
    response->gravity_mode = !sim::isWeightless(simulator, part);
    response->mass = inertial.mass;
    const Matrix3& I = inertial.inertia;
    response->ixx = I(0, 0), response->ixy = I(0, 1), response->ixz = I(0, 2);
    response->iyy = I(1, 1), response->iyz = I(1, 2), response->izz = I(2, 2);
  });
}

void QueryServices::addJoints(const sim::Simulator& simulator) {
  services_.add<GetJointProperties>("get_joint_properties", [&simulator](const auto& request, auto* response) {
    const sim::JointPart part = sim::findJoint(simulator, request.joint_name, "joint_name");
    const sim::RobotInfo& robot = simulator.robots()[part.robot];
    const int joint = robot.joints[part.joint];
    const dynamics::JointState& state = simulator.report().joints[joint];
    response->type = typeOf(simulator, robot, robot.joint_names[part.joint]);
    response->damping = {simulator.jointDamping(joint)};
    response->position = {state.position};
    response->rate = {state.velocity};
  });
}

}  // namespace blem_sim::node
