#include "publishers/state_publisher.h"

#include <blem_sim/LinkStates.h>
#include <blem_sim/ModelStates.h>
#include <boost/make_shared.hpp>

#include "messages/conversions.h"
#include "messages/link_motion.h"

namespace blem_sim {

namespace {

constexpr int QUEUE_SIZE = 10;

template <typename States>
void append(const std::string& name, const LinkMotion& motion, States* states) {
  states->name.push_back(name);
  states->pose.push_back(toPose(motion.X_WL));
  states->twist.push_back(toTwist(motion.v_WL, motion.w_WL));
}

}  // namespace

StatePublisher::StatePublisher(ros::NodeHandle private_node, const Simulator& simulator, StepSender* sender)
    : simulator_(simulator),
      schedule_(simulator.config().rates.link_states),
      links_(ListenedPublisher::advertise<LinkStates>(&private_node, "link_states", QUEUE_SIZE)),
      models_(ListenedPublisher::advertise<ModelStates>(&private_node, "model_states", QUEUE_SIZE)),
      sender_(sender) {}

void StatePublisher::publish(const StepReport& report) {
  if (!schedule_.due(report.time)) return;
  if (links_.listened()) publishLinks(report);
  if (models_.listened()) publishModels(report);
}

void StatePublisher::publishLinks(const StepReport& report) {
  const auto message = boost::make_shared<LinkStates>();
  for (const RobotInfo& robot : simulator_.robots()) {
    const int links = static_cast<int>(robot.description->links.size());
    for (int link = 0; link < links; ++link) {
      append(robot.name + "::" + robot.description->links[link].name, linkMotion(simulator_, report, robot, link), message.get());
    }
  }
  for (const ModelInfo& model : simulator_.models()) {
    if (model.kind != ModelKind::OBJECT || !model.alive) continue;
    for (const int body : model.bodies) append(simulator_.bodyName(body), bodyMotion(simulator_, report, body), message.get());
  }
  sender_->add(&links_, message);
}

void StatePublisher::publishModels(const StepReport& report) {
  const auto message = boost::make_shared<ModelStates>();
  const int models = static_cast<int>(simulator_.models().size());
  for (int model = 0; model < models; ++model) {
    if (simulator_.models()[model].alive) append(simulator_.models()[model].name, modelMotion(simulator_, report, model), message.get());
  }
  sender_->add(&models_, message);
}

}  // namespace blem_sim
