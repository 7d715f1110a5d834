// Loops that several threads share.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace blem_sim::geometry {

constexpr std::size_t FEW_ITEMS = 1024;  ///< items that are not worth another thread

/** Calls body(i) for each i from 0 to count - 1, in any order; a small number of them in the caller's thread alone. */
template <typename Index, typename Body>
void forAll(Index count, Body&& body) {
  tbb::parallel_for(tbb::blocked_range<Index>(Index{0}, count, FEW_ITEMS), [&](const tbb::blocked_range<Index>& range) {
    for (Index i = range.begin(); i < range.end(); ++i) body(i);
  });
}

}  // namespace blem_sim::geometry
