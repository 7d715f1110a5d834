// Sets of items, which several threads join.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>

#include "blem_sim/geometry/for_all.h"

namespace blem_sim::geometry {

/** Sets that grow together; each is told by its first item, so that the result does not depend on who joined what when. */
class DisjointSets {
 public:
  /** Each item alone. */
  explicit DisjointSets(int count) : DisjointSets(count, [](int item) { return item; }) {}

  /** @param firstOf of an item: the first item of its set */
  template <typename FirstOf>
  DisjointSets(int count, FirstOf&& firstOf) : parents_(new std::atomic<int>[static_cast<std::size_t>(count)]) {
    forAll(count, [&](int i) { parents_[i].store(firstOf(i), std::memory_order_relaxed); });
  }

  /** First item of the set that this one is in. */
  int first(int item) {
    for (int parent = parentOf(item); parent != item; parent = parentOf(item)) {
      const int above = parentOf(parent);
      if (above != parent) parents_[item].store(above, std::memory_order_relaxed);  // the next way is shorter
      item = above;
    }
    return item;
  }

  void join(int item, int other) {
    for (;;) {
      item = first(item);
      other = first(other);
      if (item == other) return;
      int low = std::min(item, other), high = std::max(item, other);
      if (parents_[high].compare_exchange_strong(high, low, std::memory_order_relaxed)) return;  // still the first of its set
    }
  }

 private:
  int parentOf(int item) const { return parents_[item].load(std::memory_order_relaxed); }

  std::unique_ptr<std::atomic<int>[]> parents_;  // towards the first item, which is its own
};

}  // namespace blem_sim::geometry
