#include "publishers/contact_publisher.h"

#include <boost/make_shared.hpp>

#include <algorithm>

#include "messages/contact_messages.h"
#include "messages/conversions.h"

namespace blem_sim {

namespace {

constexpr int CONTACT_QUEUE = 100;

/** [N] weight of everything that moves. */
double totalWeight(const Simulator& simulator) {
  double mass = 0;
  for (const ModelInfo& model : simulator.models()) {
    for (const int body : model.bodies) {
      if (body != WORLD_BODY) mass += simulator.world().bodySpec(body).inertial.mass;
    }
  }
  return mass * std::max(1.0, simulator.gravity().norm());
}

double metresPerNewton(const Simulator& simulator) {
  const double weight = totalWeight(simulator);
  return weight > 0 ? ContactMarkerPublisher::LENGTH_OF_WEIGHT / weight : 0;
}

}  // namespace

ContactPublisher::ContactPublisher(ros::NodeHandle private_node, const Simulator& simulator, StepSender* sender)
    : simulator_(simulator),
      schedule_(simulator.config().rates.contact),
      publisher_(ListenedPublisher::advertise<ContactArray>(&private_node, "contacts", CONTACT_QUEUE)),
      sender_(sender) {}

void ContactPublisher::publish(const StepReport& report) {
  if (!schedule_.due(report.time) || !publisher_.listened()) return;
  sender_->add(&publisher_, boost::make_shared<ContactArray>(toContactArray(simulator_, report)));
}

ContactMarkerPublisher::ContactMarkerPublisher(ros::NodeHandle private_node, const Simulator& simulator, StepSender* sender)
    : simulator_(simulator),
      schedule_(simulator.config().rates.markers),
      markers_(&private_node, "contact_markers", metresPerNewton(simulator)),
      sender_(sender) {}

void ContactMarkerPublisher::modelsChanged() { markers_.setScale(metresPerNewton(simulator_)); }

void ContactMarkerPublisher::publish(const StepReport& report) {
  if (!schedule_.due(report.time) || !markers_.listened()) return;
  const auto contacts = contacts_.spare();
  contacts->stamp = toStamp(report.time);
  contacts->contacts = report.contacts;
  sender_->add(&markers_, contacts);
}

}  // namespace blem_sim
