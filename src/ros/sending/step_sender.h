// Publishes the messages of steps in a thread of its own.
#pragma once

#include <boost/shared_ptr.hpp>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace blem_sim::node {

/**
 * Serialising messages and waking roscpp's poll thread for each takes longer than filling them: the thread that steps only fills. In order:
 * a step's messages go out as they were added, and after those of the steps before. All but the thread's work is called by one thread.
 *
 * Waking a thread takes longer than filling, too. While hand-overs come LONGEST_NAP apart or less, the thread wakes by itself when it
 * expects the next one: as long after the last as that came after the one before. Messages that come sooner wait until then, but not past
 * the hand-over after theirs. If the hand-over is late the thread looks some more times; then it sleeps until it is woken.
 */
class StepSender {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::microseconds LONGEST_NAP{2500};

  explicit StepSender(Clock::duration longest_nap = LONGEST_NAP);
  /** Sends all messages handed over before. */
  ~StepSender();
  StepSender(const StepSender&) = delete;
  StepSender& operator=(const StepSender&) = delete;

  /** @param publisher its publish(message) is called once after the next send(), in the sender's thread; has to be there until then */
  template <typename Publisher, typename Message>
  void add(Publisher* publisher, boost::shared_ptr<Message> message) {
    const auto publish = [](void* to, const boost::shared_ptr<void>& what) {
      static_cast<Publisher*>(to)->publish(boost::static_pointer_cast<Message>(what));
    };
    added_.push_back({publish, publisher, std::move(message)});
  }
  /** Hands over the added messages. Waits only if the thread is far behind. */
  void send();
  /** Returns when all messages handed over have been published; none of them waits for a nap to end. */
  void drain();

 private:
  struct Outgoing {
    void (*publish)(void* publisher, const boost::shared_ptr<void>& message);
    void* publisher;
    boost::shared_ptr<void> message;
  };

  void run();
  void rest(std::unique_lock<std::mutex>* lock);

  std::vector<Outgoing> added_;
  std::mutex mutex_;
  std::condition_variable handed_over_, published_;
  std::vector<Outgoing> waiting_;  // for the thread
  Clock::time_point last_;         // hand-over
  const Clock::duration longest_nap_;
  Clock::duration interval_;  // of the last two hand-overs
  bool naps_ = false, busy_ = false, ends_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace blem_sim::node
