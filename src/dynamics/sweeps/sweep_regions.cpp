#include "sweeps/sweep_regions.h"

#include <algorithm>

namespace blem_sim::dynamics {
namespace {

constexpr std::size_t LARGE = 400, HUGE_ISLAND = 8000;  // pairs of an island in two regions, in four
constexpr std::size_t MOST_BORDER = 4;                  // a fourth of the pairs at most lie between regions

}  // namespace

void SweepRegions::find(const IslandAtHand& island, const IslandResponse& response, const std::vector<ResponsePair>& pairs) {
  count_ = 0;
  region_.assign(response.movers(), 0);
  if (pairs.size() < LARGE) return;
  findPlaces(island, response, pairs);
  const int levels = pairs.size() < HUGE_ISLAND ? 1 : 2;
  cut(0, places_.size(), levels);
  count_ = 1 << levels;
  std::size_t border = 0;
  for (const ResponsePair& pair : pairs) border += ofPair(response, pair) == count_ ? 1 : 0;
  if (MOST_BORDER * border <= pairs.size()) return;
  count_ = 0;
  region_.assign(response.movers(), 0);
}

int SweepRegions::ofPair(const IslandResponse& response, const ResponsePair& pair) const {
  const int region = region_[response.moverOf(pair.a)];
  return pair.pair.b < 0 || region_[response.moverOf(pair.b)] == region ? region : count_;
}

void SweepRegions::findPlaces(const IslandAtHand& island, const IslandResponse& response, const std::vector<ResponsePair>& pairs) {
  places_.clear();
  touching_.assign(response.movers(), 0);
  const auto touch = [&](const ResponseSide& side) {
    if (side.node < 0) return;
    const int mover = response.moverOf(side);
    if (touching_[mover]++ == 0) places_.push_back({mover, island.motion.reference[island.forest.nodes()[side.node].tree]});
  };
  for (const ResponsePair& pair : pairs) {
    touch(pair.a);
    touch(pair.b);
  }
}

// Halves that touch as many pairs.
void SweepRegions::cut(std::size_t begin, std::size_t end, int levels) {
  if (levels == 0 || begin == end) return;
  Vector3 least = places_[begin].point, most = least;
  long all = 0;
  for (std::size_t i = begin; i < end; ++i) {
    least = least.cwiseMin(places_[i].point);
    most = most.cwiseMax(places_[i].point);
    all += touching_[places_[i].mover];
  }
  int axis = 0;
  (most - least).maxCoeff(&axis);
  std::sort(places_.begin() + begin, places_.begin() + end, [axis](const Place& a, const Place& b) {
    return a.point[axis] < b.point[axis] || (a.point[axis] == b.point[axis] && a.mover < b.mover);
  });
  std::size_t middle = begin;
  for (long below = 0; 2 * below < all; ++middle) below += touching_[places_[middle].mover];
  for (std::size_t i = begin; i < end; ++i) region_[places_[i].mover] = 2 * region_[places_[i].mover] + (i < middle ? 0 : 1);
  cut(begin, middle, levels - 1);
  cut(middle, end, levels - 1);
}

}  // namespace blem_sim::dynamics
