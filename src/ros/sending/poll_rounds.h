// Order of a message and a link to a new subscriber: rounds of roscpp's poll thread tell which came first.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

namespace blem_sim::node {

/**
 * roscpp's poll thread works in rounds: first it hands queued messages to the links there are, then it serves the sockets, where new links
 * come from. A message that is queued after round n is handed over in round n + 1: links made in round n or before get it, later ones do
 * not. So that a message is never queued in the middle of a hand-over, publishers publish under betweenHandOvers().
 */
class PollRounds {
 public:
  static PollRounds& instance();

  /** Call after ros::init and before the first NodeHandle: roscpp's own hand-over then lies between the two listeners of a round. */
  void watchBegin();
  /** Call once roscpp has started. */
  void watchEnd();

  /** Keeps the poll thread from handing messages over while it lives. Given up after 100 ms, and at once while roscpp shuts down: the
   *  poll thread does so in the middle of a round and does not come back. A thread may ask for it again while it has it. */
  std::unique_lock<std::recursive_timed_mutex> betweenHandOvers();
  /** Number of rounds so far. To be asked between hand-overs, or in the poll thread. */
  std::uint64_t count() const { return count_; }

 private:
  PollRounds() = default;
  void begin();
  void end();

  std::recursive_timed_mutex mutex_;
  std::atomic<std::uint64_t> count_{0};
  std::atomic<bool> both_ends_{false};
  std::once_flag end_watched_;
  bool held_ = false;  ///< of the poll thread: it holds the mutex
};

}  // namespace blem_sim::node
