#include "sending/step_sender.h"

#include <algorithm>
#include <iterator>

#include "sending/poll_rounds.h"

namespace blem_sim::node {

namespace {
// More than the messages of some hundred steps: send() waits for a thread that is so far behind.
constexpr std::size_t MOST_WAITING = 5000;
// Looks for a late hand-over, in the time between two of them.
constexpr int LOOKS = 8;
}  // namespace

StepSender::StepSender(Clock::duration longest_nap)
    : last_(Clock::now()), longest_nap_(longest_nap), interval_(2 * longest_nap), thread_([this] { run(); }) {}

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
  bool wakes = true;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    published_.wait(lock, [this] { return waiting_.size() < MOST_WAITING; });
    const Clock::time_point now = Clock::now();
    interval_ = now - last_;
    last_ = now;
    wakes = !naps_ || !waiting_.empty();
    if (waiting_.empty()) {
      waiting_.swap(added_);
    } else {
      std::move(added_.begin(), added_.end(), std::back_inserter(waiting_));
    }
  }
  added_.clear();
  if (wakes) handed_over_.notify_one();
}

void StepSender::drain() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!waiting_.empty()) handed_over_.notify_one();
  published_.wait(lock, [this] { return waiting_.empty() && !busy_; });
}

void StepSender::rest(std::unique_lock<std::mutex>* lock) {
  const Clock::time_point now = Clock::now();
  const Clock::time_point expected = last_ + interval_;
  naps_ = interval_ <= longest_nap_ && now < expected + interval_;
  if (naps_) {
    handed_over_.wait_until(*lock, std::max(expected, now + interval_ / LOOKS));
  } else {
    handed_over_.wait(*lock);
  }
  naps_ = false;
}

void StepSender::run() {
  std::vector<Outgoing> batch;
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    while (waiting_.empty()) {
      if (ends_) return;
      rest(&lock);
    }
    batch.swap(waiting_);
    busy_ = true;
    lock.unlock();
    {
      // One hand-over for all: else the poll thread, woken by the first, is in the way of the others.
      const auto between = PollRounds::instance().betweenHandOvers();
      for (const Outgoing& outgoing : batch) outgoing.publish(outgoing.publisher, outgoing.message);
    }
    batch.clear();
    lock.lock();
    busy_ = false;
    published_.notify_all();
  }
}

}  // namespace blem_sim::node
