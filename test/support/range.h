// Range of a quantity over a run.
#pragma once

#include <algorithm>
#include <cmath>

namespace blem_sim {

/** Least and greatest of a quantity. */
struct Range {
  double low = INFINITY, high = -INFINITY;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double width() const { return high - low; }
};

}  // namespace blem_sim
