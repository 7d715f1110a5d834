// Threads that share the loops of a step.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <optional>

#include "blem_sim/dynamics/world_types.h"

namespace blem_sim::sim {

constexpr std::size_t PAIRS_AT_ONCE = 64;  ///< pairs in a piece of a loop that looks at each for a microsecond or less

/** Chance decides which thread takes a piece of a loop, so pieces must not depend on each other: then results are the same for any number
 *  of threads. */
class StepThreads {
 public:
  /** @param asked of SolverSettings; no more than the processors there are */
  explicit StepThreads(std::optional<int> asked)
      : asked_(asked), arena_(std::min(dynamics::mostThreads(asked), tbb::this_task_arena::max_concurrency())) {
    expect(0);
  }

  int most() const { return arena_.max_concurrency(); }

  /** Takes as many threads as the loops of a step of so many contacts are worth. */
  void expect(std::size_t contacts) { count_ = std::min(dynamics::threadsFor(asked_, contacts), most()); }

  /** @return work(); loops of TBB in it keep to these threads */
  template <typename Work>
  auto with(const Work& work) {
    return (count_ == 1 ? alone_ : arena_).execute(work);
  }

  /** Calls body(i, thread) for each i from 0 to count - 1, in any order and at once, thread from 0 to most() - 1; up to a `piece` of them
   *  in the caller's thread alone. */
  template <typename Body>
  void forAll(std::size_t count, std::size_t piece, const Body& body) {
    if (count_ == 1 || count <= piece) {
      for (std::size_t i = 0; i < count; ++i) body(i, std::size_t{0});
      return;
    }
    arena_.execute([&] {
      const auto run = [&](const tbb::blocked_range<std::size_t>& range) {
        const auto thread = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
        for (std::size_t i = range.begin(); i < range.end(); ++i) body(i, thread);
      };
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, piece), run, tbb::simple_partitioner());
    });
  }

  /** Whether holds(i) for any i from 0 to count - 1. */
  template <typename Holds>
  bool anyOf(std::size_t count, std::size_t piece, const Holds& holds) {
    std::atomic<bool> found{false};
    forAll(count, piece, [&](std::size_t i, std::size_t) {
      if (!found.load(std::memory_order_relaxed) && holds(i)) found.store(true, std::memory_order_relaxed);
    });
    return found.load(std::memory_order_relaxed);
  }

 private:
  std::optional<int> asked_;
  tbb::task_arena arena_;
  tbb::task_arena alone_{1};
  int count_ = 1;  // of the step at hand
};

}  // namespace blem_sim::sim
