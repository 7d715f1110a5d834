#include "publishers/state_publisher.h"

#include <blem_sim/LinkStates.h>
#include <boost/make_shared.hpp>

#include "messages/model_states.h"

namespace blem_sim::node {

namespace {
constexpr int STATE_QUEUE = 10;
}  // namespace

StatePublisher::StatePublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender)
    : simulator_(simulator),
      schedule_(simulator.config().rates.link_states),
      links_(ListenedPublisher::advertise<LinkStates>(&private_node, "link_states", STATE_QUEUE)),
      models_(ListenedPublisher::advertise<ModelStates>(&private_node, "model_states", STATE_QUEUE)),
      sender_(sender) {}

void StatePublisher::publish(const sim::StepReport& report) {
  if (!schedule_.due(report.time)) return;
  if (links_.listened()) publishLinks(report);
  if (models_.listened()) publishModels(report);
}

void StatePublisher::publishLinks(const sim::StepReport& report) {
  const auto message = boost::make_shared<LinkStates>();
  for (const sim::RobotInfo& robot : simulator_.robots()) {
    const int links = static_cast<int>(robot.description->links.size());
    for (int link = 0; link < links; ++link) {
      append(robot.name + "::" + robot.description->links[link].name, linkMotion(simulator_, report, robot, link), message.get());
    }
  }
  for (const sim::ModelInfo& model : simulator_.models()) {
    if (model.kind != sim::ModelKind::OBJECT || !model.alive) continue;
    for (const int body : model.bodies) append(simulator_.bodyName(body), bodyMotion(simulator_, report, body), message.get());
  }
  sender_->add(&links_, message);
}

void StatePublisher::publishModels(const sim::StepReport& report) {
  const auto message = boost::make_shared<ModelStates>();
  appendModels(simulator_, report, message.get());
  sender_->add(&models_, message);
}

}  // namespace blem_sim::node
