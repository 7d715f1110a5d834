#include "newton/line_search.h"

#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr int MAX_LINE_SEARCH = 30;
constexpr double LINE_SEARCH_SLOPE = 1e-3;  // of the first slope: below it the search is near enough to its minimum

/** The direction's slopes at the iterate. */
struct DirectionSlopes {
  double linear = 0, quadratic = 0;  // of the kinetic part: slope linear + a quadratic
  double start = 0;                  // of the objective
};

DirectionSlopes slopesOf(const SolverSpace& s, const std::vector<int>& dofs) {
  DirectionSlopes slopes;
  for (const int k : dofs) {
    slopes.quadratic += s.direction[k] * s.mass_direction[k];
    slopes.linear += s.direction[k] * s.kinetic[k];
    slopes.start += s.direction[k] * s.gradient[k];
  }
  return slopes;
}

}  // namespace

double searchLine(const IslandAtHand& island, IslandIterate* iterate) {
  iterate->setDirection();
  const DirectionSlopes slopes = slopesOf(*island.space, iterate->live().dofs());
  double low = 0, high = -1, a = 1;
  for (int it = 0; it < MAX_LINE_SEARCH; ++it) {
    const PotentialSlope here = iterate->reactions().slope(a, {slopes.linear + a * slopes.quadratic, slopes.quadratic});
    if (std::abs(here.first) <= LINE_SEARCH_SLOPE * std::abs(slopes.start)) break;
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
