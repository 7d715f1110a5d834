// A thread for messages that take long to make.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace blem_sim::node {

/** Draws and publishes beside the steps, in order. None is left out: who is many jobs ahead waits. All but the thread's work is called by
 *  one thread. */
class DrawingThread {
 public:
  DrawingThread();
  /** Waits for the job at hand only. */
  ~DrawingThread();
  DrawingThread(const DrawingThread&) = delete;
  DrawingThread& operator=(const DrawingThread&) = delete;

  void add(std::function<void()> job);
  /** Returns when all jobs are done. */
  void drain();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool busy_ = false, ends_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace blem_sim::node
