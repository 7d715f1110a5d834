// Order in which an island's pairs are swept: from the ground up, in groups of eight, each between bodies of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "problem/island_at_hand.h"
#include "trees/island_response.h"

namespace blem_sim::dynamics {

/** Groups of one colour have no body in common. Those of the last colour may have: their pairs found no colour, and take turns. */
class SweepOrder {
 public:
  /** @param pairs responses of the island's pairs; groups: their pairs and contacts, out */
  void find(const IslandAtHand& island, const IslandResponse& response, const std::vector<ResponsePair>& pairs,
            std::vector<SweepGroup>* groups);

  int colours() const { return static_cast<int>(group_start_.size()) - 1; }
  std::size_t firstGroup(int colour) const { return group_start_[colour]; }
  std::size_t groupEnd(int colour) const { return group_start_[colour + 1]; }
  bool isLast(int colour) const { return colour + 1 == colours(); }

 private:
  void sortByHeight();
  void colourPairs(const IslandResponse& response, const std::vector<ResponsePair>& pairs);
  void sortByColour();
  void layGroups(int colour, std::vector<SweepGroup>* groups);
  int contactsOf(int pair) const { return island_->model.pairs[pair].end - island_->model.pairs[pair].first; }

  const IslandAtHand* island_ = nullptr;
  std::vector<double> heights_;
  std::vector<int> order_, colour_, colour_start_;
  std::vector<std::uint64_t> used_colours_;  // by mover
  std::vector<int> by_colour_, chosen_;
  std::vector<std::size_t> group_start_;  // by colour
};

}  // namespace blem_sim::dynamics
