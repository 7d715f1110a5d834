#include "trees/team.h"

#include "trees/wait.h"

namespace blem_sim::dynamics {

void Team::gather(int helpers, tbb::task_group* group) {
  gathered_ = true;
  dismissed_.store(false, std::memory_order_relaxed);
  for (int i = 0; i < helpers; ++i) group->run([this] { help(); });
}

void Team::dismiss(tbb::task_group* group) {
  dismissed_.store(true, std::memory_order_release);
  group->wait();
  gathered_ = false;
}

// Chunks are taken from the last to the first: the counter of a loop that is done stays at zero, so a late thread takes nothing.
bool Team::takeChunk() {
  int left = left_.load(std::memory_order_acquire);
  while (left > 0) {
    if (!left_.compare_exchange_weak(left, left - 1, std::memory_order_acq_rel, std::memory_order_acquire)) continue;
    call_(body_, left - 1);
    done_.fetch_add(1, std::memory_order_release);
    return true;
  }
  return false;
}

void Team::run(int count, const void* body, Call call) {
  body_ = body;
  call_ = call;
  done_.store(0, std::memory_order_relaxed);
  left_.store(count, std::memory_order_release);
  while (takeChunk()) {
  }
  for (Wait wait; done_.load(std::memory_order_acquire) < count;) wait.once();
}

void Team::help() {
  Wait wait;
  while (!dismissed_.load(std::memory_order_acquire)) {
    if (takeChunk())
      wait = Wait();
    else
      wait.once();
  }
}

}  // namespace blem_sim::dynamics
