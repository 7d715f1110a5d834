// Messages that are filled again and again, shared with those that still read them.
#pragma once

#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>

#include <atomic>
#include <utility>
#include <vector>

namespace blem_sim::node {

template <typename Message>
class MessagePool {
 public:
  /** @param model new messages are copies of it */
  explicit MessagePool(Message model = Message()) : model_(std::move(model)) {}

  /** A message that nobody else holds: one as it was last filled, or a new one. To be asked for by one thread. */
  boost::shared_ptr<Message> spare() {
    for (const boost::shared_ptr<Message>& message : messages_) {
      if (message.use_count() > 1) continue;
      std::atomic_thread_fence(std::memory_order_acquire);  // the last reader was another thread
      return message;
    }
    messages_.push_back(boost::make_shared<Message>(model_));
    return messages_.back();
  }

 private:
  Message model_;
  std::vector<boost::shared_ptr<Message>> messages_;
};

}  // namespace blem_sim::node
