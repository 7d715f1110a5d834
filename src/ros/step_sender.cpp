#include "step_sender.h"

#include <iterator>
#include <utility>

#include "poll_rounds.h"

namespace blem_sim {

namespace {
// More than the messages of some hundred steps: who is that far behind has to be waited for.
constexpr std::size_t MOST_WAITING = 5000;
}  // namespace

StepSender::StepSender() : thread_([this] { run(); }) {}

StepSender::~StepSender() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  handed_over_.notify_one();
  thread_.join();
}

void StepSender::send() {
  if (added_.empty()) return;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    published_.wait(lock, [this] { return waiting_.size() < MOST_WAITING; });
    if (waiting_.empty()) {
      waiting_.swap(added_);
    } else {
      std::move(added_.begin(), added_.end(), std::back_inserter(waiting_));
    }
  }
  added_.clear();
  handed_over_.notify_one();
}

void StepSender::drain() {
  std::unique_lock<std::mutex> lock(mutex_);
  published_.wait(lock, [this] { return waiting_.empty() && !busy_; });
}

void StepSender::run() {
  std::vector<std::function<void()>> batch;
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    handed_over_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    batch.swap(waiting_);
    busy_ = true;
    lock.unlock();
    {
      // One hand-over for all: else the poll thread, woken by the first, is in the way of the others.
      const auto between = PollRounds::instance().betweenHandOvers();
      for (const auto& publish : batch) publish();
    }
    batch.clear();
    lock.lock();
    busy_ = false;
    published_.notify_all();
  }
}

}  // namespace blem_sim
