#include "publishers/clock_publisher.h"

#include "messages/conversions.h"

namespace blem_sim::node {

namespace {
// Queue long enough for every stamp of a batch of steps made between two flushes of the outbox.
constexpr int CLOCK_QUEUE = 1000;
}  // namespace

ClockPublisher::ClockPublisher(ros::NodeHandle node, double rate, StepSender* sender)
    : publisher_(&node, "/clock", CLOCK_QUEUE), schedule_(rate), sender_(sender) {}

void ClockPublisher::publish(const sim::StepReport& report) {
  const ros::Time now = toStamp(report.time);
  // A restart may lead back, but not to the stamp that everybody has.
  if (published_ && (restarted_ ? now == last_ : now <= last_)) return;
  if (!schedule_.due(report.time)) return;
  const auto message = messages_.spare();
  message->clock = now;
  sender_->add(&publisher_, message);
  published_ = true;
  restarted_ = false;
  last_ = now;
}

void ClockPublisher::timeRestarted() {
  schedule_.restart();
  restarted_ = true;
}

}  // namespace blem_sim::node
