// Publishers whose late subscribers learn the last message during a pause.
#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/single_subscriber_publisher.h>

#include <memory>
#include <mutex>
#include <string>

namespace blem_sim {

/** Runs callbacks at once, in the transport's thread. */
class ImmediateQueue : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override { callback->call(); }
  void removeByID(std::uint64_t) override {}
};

/**
 * A publisher that gives a new subscriber the last message during a pause. roscpp's own latching does so at any time, a moment after the
 * connection, and so gives a message twice to who connects while messages are under way; stamps must never repeat.
 */
template <typename Message>
class GreetingPublisher {
 public:
  GreetingPublisher(ros::NodeHandle* node, const std::string& topic, int queue_size) : state_(std::make_shared<State>()) {
    // The transport may call after this object is gone, so the callback shares the state.
    const std::shared_ptr<State> state = state_;
    const auto greet = [state](const ros::SingleSubscriberPublisher& subscriber) {
      const std::lock_guard<std::mutex> lock(state->mutex);
      if (state->settled) subscriber.publish(state->message);
    };
    ros::AdvertiseOptions options = ros::AdvertiseOptions::create<Message>(topic, queue_size, greet, ros::SubscriberStatusCallback(),
                                                                           ros::VoidConstPtr(), immediateQueue());
    publisher_ = node->advertise(options);
  }

  void publish(const Message& message) {
    {
      const std::lock_guard<std::mutex> lock(state_->mutex);
      state_->message = message;
      state_->published = true;
      state_->settled = false;
    }
    publisher_.publish(message);
  }

  /** What was published has reached every link there is: who connects from now on until the next message has not got the last one. */
  void settle() {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->settled = state_->published;
  }

 private:
  struct State {
    std::mutex mutex;
    Message message;
    bool published = false, settled = false;
  };

  static ImmediateQueue* immediateQueue() {
    static ImmediateQueue queue;
    return &queue;
  }

  std::shared_ptr<State> state_;
  ros::Publisher publisher_;
};

}  // namespace blem_sim
