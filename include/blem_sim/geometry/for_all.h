// Loops that several threads share.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>
#include <functional>

namespace blem_sim::geometry {

constexpr std::size_t FEW_ITEMS = 1024;  ///< items that are not worth another thread

/** Calls body(range) for parts of [0, count), in any order; for all of it, in the caller's thread, if that is no more than a grain. */
template <typename Index, typename Body>
void forParts(Index count, std::size_t grain, Body&& body) {
  const tbb::blocked_range<Index> all(Index{0}, count, grain);
  if (!all.is_divisible()) return body(all);
  tbb::parallel_for(all, body);
}

/** Calls body(i) for each i from 0 to count - 1, in any order; no more than a grain of them in the caller's thread alone. */
template <typename Index, typename Body>
void forAll(Index count, Body&& body, std::size_t grain = FEW_ITEMS) {
  forParts(count, grain, [&](const tbb::blocked_range<Index>& range) {
    for (Index i = range.begin(); i < range.end(); ++i) body(i);
  });
}

/**
 * A sum over parts of a range, in their order; of no more than a grain, in the caller's thread alone.
 * @param none the sum of nothing @param addTo addTo(part, sum) gives the sum with a part's @param join of the sums of two neighbours
 */
template <typename Range, typename Sum, typename AddTo, typename Join = std::plus<Sum>>
Sum sumOfParts(const Range& all, const Sum& none, AddTo&& addTo, Join&& join = Join()) {
  return all.is_divisible() ? tbb::parallel_reduce(all, none, addTo, join) : addTo(all, none);
}

}  // namespace blem_sim::geometry
