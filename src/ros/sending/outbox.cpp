#include "sending/outbox.h"

#include <ros/poll_manager.h>

#include <algorithm>
#include <chrono>

namespace blem_sim::node {

Outbox::Outbox() : listener_(ros::PollManager::instance()->addPollThreadListener([this] { roundStarted(); })) {}

Outbox::~Outbox() { ros::PollManager::instance()->removePollThreadListener(listener_); }

void Outbox::roundStarted() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++rounds_;
  changed_.notify_all();
}

void Outbox::flush() {
  // A round of the poll thread: queues to links, then links to sockets. The round under way may be past the queues, so the second one
  // takes the messages over, and the start of a third says that the second is through.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t wanted = rounds_ + 3;
  while (rounds_ < wanted) {
    lock.unlock();
    ros::PollManager::instance()->getPollSet().signal();
    lock.lock();
    const std::uint64_t seen = rounds_;
    const auto next_round = std::min(deadline, std::chrono::steady_clock::now() + std::chrono::milliseconds(10));
    changed_.wait_until(lock, next_round, [&] { return rounds_ != seen; });
    if (std::chrono::steady_clock::now() >= deadline) return;
  }
}

}  // namespace blem_sim::node
