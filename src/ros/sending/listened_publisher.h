// Publishers that know whether anybody listens.
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <memory>
#include <string>

#include "sending/immediate_queue.h"
#include "sending/own_topic.h"

namespace blem_sim::node {

/** Counts subscribers as they come and go: roscpp, asked for them, takes a lock that it holds while it publishes. */
class ListenedPublisher {
 public:
  template <typename Message>
  static ListenedPublisher advertise(ros::NodeHandle* node, const std::string& topic, int queue_size) {
    ListenedPublisher made;
    // The transport may call after this object is gone, so the callbacks share the count.
    const std::shared_ptr<std::atomic<int>> listeners = made.listeners_;
    const auto comes = [listeners](const ros::SingleSubscriberPublisher&) { ++*listeners; };
    const auto goes = [listeners](const ros::SingleSubscriberPublisher&) { --*listeners; };
    ros::AdvertiseOptions options =
        ros::AdvertiseOptions::create<Message>(topic, queue_size, comes, goes, ros::VoidConstPtr(), ImmediateQueue::instance());
    made.publisher_ = advertiseOwn(node, options);
    return made;
  }

  bool listened() const { return *listeners_ > 0; }
  template <typename Message>
  void publish(const boost::shared_ptr<Message>& message) const {
    publisher_.publish(message);
  }

 private:
  ListenedPublisher() : listeners_(std::make_shared<std::atomic<int>>(0)) {}

  std::shared_ptr<std::atomic<int>> listeners_;
  ros::Publisher publisher_;
};

}  // namespace blem_sim::node
