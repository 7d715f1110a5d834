// The narrow phase of many pairs, on several threads, each pair with its memory.
#pragma once

#include <tbb/task_arena.h>

#include <functional>
#include <vector>

#include "blem_sim/contact/collider_pairs.h"
#include "blem_sim/contact/narrow_phase.h"

namespace blem_sim::sim {

struct WatchedPair;

/** Searches pairs, each with a memory that lives while the pair is watched; then another gets it. Memories change no result, so they are
 *  no state. */
class PairSearches {
 public:
  explicit PairSearches(int threads);

  /** Calls search(i, memory of pairs[i]) for all, in any order and at once. @param pairs sorted by (a, b) */
  void run(const std::vector<WatchedPair>& pairs, const std::function<void(std::size_t, contact::NarrowPhaseMemory*)>& search);
  /** Forgets the pairs of a collider whose slot another one may take. */
  void forget(int collider) { contact::removePairsOf(collider, &known_); }

 private:
  struct Known {
    int a, b;
    contact::NarrowPhaseMemory memory;
  };
  void watch(const std::vector<WatchedPair>& pairs);
  void giveBack(const std::vector<WatchedPair>& pairs);
  contact::NarrowPhaseMemory takeSpare();

  std::vector<Known> known_, before_;              // sorted by (a, b)
  std::vector<contact::NarrowPhaseMemory> spare_;  // of pairs that went
  int threads_;
  tbb::task_arena arena_;
};

}  // namespace blem_sim::sim
