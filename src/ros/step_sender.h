// Publishes the messages of steps in a thread of its own.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace blem_sim {

/**
 * Serialising messages and waking roscpp's poll thread for each takes longer than filling them: the thread that steps only fills. In order:
 * a step's messages go out as they were added, and after those of the steps before. All but the thread's work is called by one thread.
 */
class StepSender {
 public:
  StepSender();
  /** Sends what was handed over before. */
  ~StepSender();
  StepSender(const StepSender&) = delete;
  StepSender& operator=(const StepSender&) = delete;

  /** @param publish is called once after the next send() */
  void add(std::function<void()> publish) { added_.push_back(std::move(publish)); }
  /** Hands over what was added. Waits only if the thread is far behind. */
  void send();
  /** Returns when all that was handed over has been published. */
  void drain();

 private:
  void run();

  std::vector<std::function<void()>> added_;
  std::mutex mutex_;
  std::condition_variable handed_over_, published_;
  std::vector<std::function<void()>> waiting_;  // for the thread
  bool busy_ = false, ends_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace blem_sim
