// Loops that several threads share.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace blem_sim::geometry {

/** Calls body(i) for each i from 0 to count - 1, in any order; a small number of them in the caller's thread alone. */
template <typename Index, typename Body>
void forAll(Index count, Body&& body) {
  constexpr std::size_t FEW = 1024;
  tbb::parallel_for(tbb::blocked_range<Index>(Index{0}, count, FEW), [&](const tbb::blocked_range<Index>& range) {
    for (Index i = range.begin(); i < range.end(); ++i) body(i);
  });
}

}  // namespace blem_sim::geometry
