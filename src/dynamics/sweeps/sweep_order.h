// Order in which an island's pairs are swept: region by region, from the ground up, in groups of eight, each between bodies of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "problem/island_at_hand.h"
#include "sweeps/sweep_regions.h"
#include "trees/island_response.h"

namespace blem_sim::dynamics {

/** Groups from `first` on, before `end`. */
struct GroupRange {
  std::size_t first = 0, end = 0;
};

/**
 * Groups of two regions have no body in common, nor have those of one colour of a region, or of the border between regions. Those of the
 * last colour may have: their pairs found no colour, and take turns.
 */
class SweepOrder {
 public:
  /** @param pairs responses of the island's pairs; groups: their pairs and contacts, out */
  void find(const IslandAtHand& island, const IslandResponse& response, const std::vector<ResponsePair>& pairs,
            std::vector<SweepGroup>* groups);

  const SweepRegions& regions() const { return regions_; }
  /** Groups of a region; of regions().count(): of the border, all groups if there are no regions. */
  GroupRange groupsOf(int region) const;
  /** Colours of the border. */
  int colours() const { return static_cast<int>(border_start_.size()) - 1; }
  GroupRange groupsOfColour(int colour) const { return {border_start_[colour], border_start_[colour + 1]}; }
  bool isLast(int colour) const { return colour + 1 == colours(); }

 private:
  void sort();
  void colourPairs(std::size_t begin, std::size_t end);
  void sortByColour(std::size_t begin, std::size_t end);
  void layGroups(int colour, std::vector<SweepGroup>* groups) const;
  int contactsOf(int pair) const { return island_->model.pairs[pair].end - island_->model.pairs[pair].first; }

  const IslandAtHand* island_ = nullptr;
  const IslandResponse* response_ = nullptr;
  const std::vector<ResponsePair>* pairs_ = nullptr;
  SweepRegions regions_;
  std::vector<double> heights_;              // by pair
  std::vector<int> order_, region_;          // pairs region by region, from the ground up; region by pair
  std::vector<std::size_t> region_start_;    // in order_, by region
  std::vector<int> colour_, colour_start_;   // by pair; of the region at hand, in by_colour_
  std::vector<std::uint64_t> used_colours_;  // by mover
  std::vector<int> by_colour_, chosen_;
  std::vector<std::size_t> groups_start_, border_start_;  // by region; by colour of the border
};

}  // namespace blem_sim::dynamics
