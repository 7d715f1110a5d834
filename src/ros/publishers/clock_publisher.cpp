#include "publishers/clock_publisher.h"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <string>

#include "messages/conversions.h"

namespace blem_sim::node {

namespace {
// Queue long enough for every stamp of a batch of steps made between two flushes of the outbox.
constexpr int CLOCK_QUEUE = 1000;

/** Another node that publishes a topic; empty if there is none, or the master does not say. */
std::string otherPublisher(const std::string& topic) {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) return "";
  XmlRpc::XmlRpcValue& published = state[0];
  for (int i = 0; i < published.size(); ++i) {
    if (static_cast<std::string>(published[i][0]) != topic) continue;
    for (int k = 0; k < published[i][1].size(); ++k) {
      const auto node = static_cast<std::string>(published[i][1][k]);
      if (node != ros::this_node::getName()) return node;
    }
  }
  return "";
}

}  // namespace

ClockPublisher::ClockPublisher(ros::NodeHandle node, double rate, StepSender* sender)
    : publisher_(&node, "/clock", CLOCK_QUEUE), schedule_(rate), sender_(sender) {
  const std::string topic = node.resolveName("/clock"), other = otherPublisher(topic);
  if (!other.empty())
    ROS_WARN("%s: is published by %s too, so times jump between the two: end that node, or remap /clock of one of them", topic.c_str(),
             other.c_str());
}

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
