// Equal items, found by a hash table that several threads fill.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "blem_sim/geometry/for_all.h"

namespace blem_sim::geometry {

/**
 * For each of `count` items the first one that equals it, itself if there is none before. Open addressing; of equal items the first wins
 * a slot, whichever thread came first, so that the result does not depend on threads.
 * @param hash of an item, equal ones have the same @param equal of two items
 */
template <typename Hash, typename Equal>
std::vector<int> firstEquals(int count, Hash&& hash, Equal&& equal) {
  constexpr int BATCH = 32, GRAIN = 4096;
  std::size_t slots = 16;
  while (slots < 2 * static_cast<std::size_t>(count)) slots *= 2;
  const std::unique_ptr<std::atomic<int>[]> items(new std::atomic<int>[slots]);  // one more than the item; 0: empty
  forAll(slots, [&](std::size_t slot) { items[slot].store(0, std::memory_order_relaxed); });
  const auto insert = [&](int item, std::size_t slot) {
    for (;; slot = (slot + 1) & (slots - 1)) {
      int there = items[slot].load(std::memory_order_relaxed);
      if (there == 0 && items[slot].compare_exchange_strong(there, item + 1, std::memory_order_relaxed)) return slot;
      if (!equal(there - 1, item)) continue;
      while (there > item + 1 && !items[slot].compare_exchange_weak(there, item + 1, std::memory_order_relaxed)) {
      }
      return slot;
    }
  };
  std::vector<int> first(count);  // until all are in: their slots
  forParts(count, GRAIN, [&](const tbb::blocked_range<int>& range) {
    std::array<std::size_t, BATCH> slot;
    for (int begin = range.begin(); begin < range.end(); begin += BATCH) {
      const int size = std::min(BATCH, range.end() - begin);
      for (int i = 0; i < size; ++i) {
        slot[i] = hash(begin + i) & (slots - 1);
        __builtin_prefetch(&items[slot[i]]);
      }
      for (int i = 0; i < size; ++i) first[begin + i] = static_cast<int>(insert(begin + i, slot[i]));
    }
  });
  forAll(count, [&](int i) { first[i] = items[static_cast<unsigned>(first[i])].load(std::memory_order_relaxed) - 1; });
  return first;
}

}  // namespace blem_sim::geometry
