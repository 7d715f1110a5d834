// Publishers whose late subscribers get the last message, also during a pause.
#pragma once

#include <ros/node_handle.h>
#include <ros/single_subscriber_publisher.h>

#include <memory>
#include <mutex>
#include <string>

#include "sending/immediate_queue.h"
#include "sending/own_topic.h"
#include "sending/poll_rounds.h"

namespace blem_sim::node {

/**
 * A publisher that gives a new subscriber the last message. roscpp's own latching does so a moment after the connection, and so gives a
 * message twice to subscribers that connect while messages are under way; here none gets one twice, or misses the last: stamps must never
 * repeat.
 */
template <typename Message>
class GreetingPublisher {
 public:
  GreetingPublisher(ros::NodeHandle* node, const std::string& topic, int queue_size) : state_(std::make_shared<State>()) {
    PollRounds::instance().watchEnd();
    // The transport may call after this object is gone, so the callback shares the state.
    const std::shared_ptr<State> state = state_;
    const auto greet = [state](const ros::SingleSubscriberPublisher& subscriber) {
      const std::lock_guard<std::mutex> lock(state->mutex);
      if (state->message && PollRounds::instance().count() > state->round) subscriber.publish(*state->message);
    };
    ros::AdvertiseOptions options = ros::AdvertiseOptions::create<Message>(topic, queue_size, greet, ros::SubscriberStatusCallback(),
                                                                           ros::VoidConstPtr(), ImmediateQueue::instance());
    publisher_ = advertiseOwn(node, options);
  }

  /** @param message not to be changed any more while others hold it */
  void publish(const boost::shared_ptr<Message>& message) {
    const auto lock_round = PollRounds::instance().betweenHandOvers();
    {
      const std::lock_guard<std::mutex> lock(state_->mutex);
      state_->message = message;
      state_->round = PollRounds::instance().count();
    }
    // As a value: a shared message is not queued where only this program listens, and a subscriber that links in this round would miss it.
    publisher_.publish(*message);
  }

  /** Forgets the last message: new subscribers get none. */
  void forget() {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->message.reset();
  }

 private:
  struct State {
    std::mutex mutex;
    boost::shared_ptr<const Message> message;  ///< the last one, or none
    std::uint64_t round = 0;                   ///< the last one before it was published
  };

  std::shared_ptr<State> state_;
  ros::Publisher publisher_;
};

}  // namespace blem_sim::node
