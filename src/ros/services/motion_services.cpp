#include "services/motion_services.h"

#include <blem_sim/ResetModel.h>
#include <blem_sim/SetLinkState.h>
#include <blem_sim/SetModelState.h>

#include "blem_sim/geometry/input_error.h"
#include "services/door/reference_frame.h"

namespace blem_sim::node {

MotionServices::MotionServices(ros::NodeHandle private_node, SimulationLoop* loop)
    : simulator_(&loop->simulator()), services_(private_node) {
  services_.add<SetModelState>("set_model_state", [this](const auto& request, auto*) { setModelState(request.model_state); });
  services_.add<SetLinkState>("set_link_state", [this](const auto& request, auto*) { setLinkState(request.link_state); });
  services_.add<SetModelConfiguration>("set_model_configuration", [this](const auto& request, auto*) { configure(request); });
  services_.add<ResetModel>("reset_model", [this](const auto& request, auto*) {
    simulator_->resetModel(sim::findModel(*simulator_, request.model_name, "model_name"));
  });
  model_states_ = subscribeCounted<ModelState>(private_node, "set_model_state", "message refused", loop->refusals(),
                                               [this](const ModelState& state) { setModelState(state); });
  link_states_ = subscribeCounted<LinkState>(private_node, "set_link_state", "message refused", loop->refusals(),
                                             [this](const LinkState& state) { setLinkState(state); });
}

void MotionServices::setModelState(const ModelState& state) {
  LinkState root;
  root.link_name = sim::linksOf(*simulator_, sim::findModel(*simulator_, state.model_name, "model_name")).front().name;
  root.pose = state.pose;
  root.twist = state.twist;
  root.reference_frame = state.reference_frame;
  setLinkState(root);
}

void MotionServices::setLinkState(const LinkState& state) {
  const sim::LinkPart part = sim::findLink(*simulator_, state.link_name, "link_name");
  const sim::LinkMotion frame = frameMotion(*simulator_, state.reference_frame, "reference_frame");
  const sim::LinkMotion motion = inWorld(frame, state.pose, state.twist, "'" + state.link_name + "'");
  if (part.body != dynamics::WORLD_BODY) return simulator_->moveModel(part.body, bodyStateOf(*simulator_, part, motion));
  constexpr double SAME_PLACE = 1e-6;
  if (motion.X_WL.isApprox(part.X_BL, SAME_PLACE)) return;
  throw InputError("'" + part.name + "' is fixed to the world; delete or unload it and put it elsewhere");
}

void MotionServices::configure(const SetModelConfiguration::Request& request) {
  sim::findModel(*simulator_, request.model_name, "model_name");
  const int robot = simulator_->robotIndex(request.model_name);
  if (robot < 0) throw InputError("model_name: '" + request.model_name + "' has no joints");
  simulator_->setJointPositions(robot, request.joint_names, request.joint_positions);
}

}  // namespace blem_sim::node
