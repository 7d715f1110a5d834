#include "sending/drawing_thread.h"

#include <utility>

namespace blem_sim::node {

namespace {
constexpr std::size_t MOST_IMAGES = 8;
}  // namespace

DrawingThread::DrawingThread() : thread_([this] { run(); }) {}

DrawingThread::~DrawingThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void DrawingThread::add(std::function<void()> job) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < MOST_IMAGES; });
  waiting_.push_back(std::move(job));
  changed_.notify_all();
}

void DrawingThread::drain() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !busy_; });
}

void DrawingThread::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (ends_) return;
    const std::function<void()> job = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = true;
    lock.unlock();
    job();
    lock.lock();
    busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace blem_sim::node
