#include "publishers/contact_publisher.h"

#include <boost/make_shared.hpp>

#include "blem_sim/sim/drawing.h"
#include "messages/contact_messages.h"
#include "messages/conversions.h"

namespace blem_sim::node {

namespace {

constexpr int CONTACT_QUEUE = 100;

double metresPerNewton(const sim::Simulator& simulator) {
  const double weight = sim::movingWeight(simulator);
  return weight > 0 ? ContactMarkerPublisher::LENGTH_OF_WEIGHT / weight : 0;
}

}  // namespace

ContactPublisher::ContactPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender)
    : simulator_(simulator),
      schedule_(simulator.config().rates.contact),
      publisher_(ListenedPublisher::advertise<ContactArray>(&private_node, "contacts", CONTACT_QUEUE)),
      sender_(sender) {}

void ContactPublisher::publish(const sim::StepReport& report) {
  if (!schedule_.due(report.time) || !publisher_.listened()) return;
  sender_->add(&publisher_, boost::make_shared<ContactArray>(toContactArray(simulator_, report)));
}

ContactMarkerPublisher::ContactMarkerPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender)
    : simulator_(simulator),
      schedule_(simulator.config().rates.markers),
      markers_(&private_node, "contact_markers", metresPerNewton(simulator)),
      sender_(sender) {}

void ContactMarkerPublisher::modelsChanged() { markers_.setScale(metresPerNewton(simulator_)); }

void ContactMarkerPublisher::publish(const sim::StepReport& report) {
  if (!schedule_.due(report.time) || !markers_.listened()) return;
  const auto contacts = contacts_.spare();
  contacts->stamp = toStamp(report.time);
  contacts->contacts = report.contacts;
  sender_->add(&markers_, contacts);
}

}  // namespace blem_sim::node
