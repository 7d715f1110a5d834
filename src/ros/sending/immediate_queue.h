#pragma once

#include <ros/callback_queue_interface.h>

#include <cstdint>

namespace blem_sim::node {

/** Runs callbacks at once, in the thread they come from: roscpp's poll thread for those of subscribers that come and go. */
class ImmediateQueue : public ros::CallbackQueueInterface {
 public:
  /** The queue of the program, which lives until it ends, as roscpp's threads do. */
  static ImmediateQueue* instance() {
    static ImmediateQueue queue;
    return &queue;
  }
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override { callback->call(); }
  void removeByID(std::uint64_t) override {}

 private:
  ImmediateQueue() = default;
};

}  // namespace blem_sim::node
