#include "newton/line_search.h"

#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr int MAX_LINE_SEARCH = 30;
constexpr double LINE_SEARCH_SLOPE = 1e-3;  // of the first slope: below it the search is near enough to its minimum

/** The slope of the objective along a direction. */
class LineSlope {
 public:
  LineSlope(const IslandAtHand& island, IslandIterate* iterate) : iterate_(iterate) {
    const SolverSpace& s = *island.space;
    for (const int k : iterate->live().dofs()) {
      quadratic_ += s.direction[k] * s.mass_direction[k];
      linear_ += s.direction[k] * s.kinetic[k];
      start_ += s.direction[k] * s.gradient[k];
    }
  }

  /** Slope at the iterate itself. */
  double start() const { return start_; }
  /** Slope, and its derivative, at a along the direction. */
  PotentialSlope at(double a) const {
    PotentialSlope slope = iterate_->respond(a);
    slope.first += linear_ + a * quadratic_;
    slope.second += quadratic_;
    iterate_->addLoopSlope(a, &slope);
    return slope;
  }

 private:
  IslandIterate* iterate_;
  double linear_ = 0, quadratic_ = 0, start_ = 0;  // the first two of the kinetic part
};

}  // namespace

double searchLine(const IslandAtHand& island, IslandIterate* iterate) {
  iterate->setDirection();
  const LineSlope slope(island, iterate);
  double low = 0, high = -1, a = 1;
  for (int it = 0; it < MAX_LINE_SEARCH; ++it) {
    const PotentialSlope here = slope.at(a);
    if (std::abs(here.first) <= LINE_SEARCH_SLOPE * std::abs(slope.start())) break;
    (here.first < 0 ? low : high) = a;
    double next = a - here.first / here.second;
    if (high > 0 && !(next > low && next < high)) next = 0.5 * (low + high);
    if (high < 0 && !(next > low)) next = 2 * a;
    if (next == a) break;
    a = next;
  }
  return a;
}

}  // namespace blem_sim::dynamics
