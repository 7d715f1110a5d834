// Waiting for another thread of a loop.
#pragma once

#include <thread>

namespace blem_sim::dynamics {

/** A wait of microseconds: the thread looks again and again, and yields the processor only after PATIENCE looks. */
class Wait {
 public:
  void once() {
    if (++looks_ > PATIENCE) return std::this_thread::yield();
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }

 private:
  static constexpr int PATIENCE = 2000;
  int looks_ = 0;
};

}  // namespace blem_sim::dynamics
