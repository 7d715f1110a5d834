#include "publishers/reports/layer_event_publisher.h"

#include <fmt/format.h>
#include <ros/console.h>
#include <boost/make_shared.hpp>

#include "messages/conversions.h"
#include "messages/status_text.h"

namespace blem_sim::node {

namespace {

constexpr int UNBOUNDED_QUEUE = 0;

LayerEvent toMessage(const sim::Simulator& simulator, const sim::LayerEventReport& event) {
  LayerEvent message;
  message.header.stamp = toStamp(event.time);
  message.header.frame_id = WORLD_FRAME;
  message.body_a = simulator.colliders()[event.collider_a].name;
  message.body_b = simulator.colliders()[event.collider_b].name;
  message.outside = event.outside;
  message.depth = event.depth;
  message.of_layer = event.of_layer;
  message.pierced = event.pierced;
  return message;
}

}  // namespace

LayerEventPublisher::LayerEventPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender)
    : simulator_(simulator), sender_(sender), publisher_(&private_node, "layer_events", UNBOUNDED_QUEUE) {}

void LayerEventPublisher::timeRestarted() {
  publisher_.forget();
  next_warning_ = 0;
  unsaid_ = 0;
}

void LayerEventPublisher::publish(const sim::StepReport& report) {
  for (const sim::LayerEventReport& event : report.layer_events) {
    const auto message = boost::make_shared<LayerEvent>(toMessage(simulator_, event));
    sender_->add(&publisher_, message);
    if (message->outside) warn(*message, event.time);
  }
}

void LayerEventPublisher::warn(const LayerEvent& event, double time) {
  if (time < next_warning_) {
    ++unsaid_;
    return;
  }
  const std::string others = unsaid_ > 0 ? fmt::format(" ({} more contacts left theirs since the last warning)", unsaid_) : "";
  ROS_WARN("t = %.3f s: %s and %s left their boundary layers (%.3g m deep, %.2f times the layers): %s%s", time, event.body_a.c_str(),
           event.body_b.c_str(), event.depth, event.of_layer, statusAdvice(sim::CONTACT_UNRELIABLE).front().c_str(), others.c_str());
  next_warning_ = time + WARNING_PERIOD;
  unsaid_ = 0;
}

}  // namespace blem_sim::node
