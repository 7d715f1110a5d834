// Regions of a large island that threads sweep at once: no body is in two of them. What lies between them is swept after them.
#pragma once

#include <vector>

#include "problem/island_at_hand.h"
#include "trees/island_response.h"

namespace blem_sim::dynamics {

/** The same for any number of threads: the island alone tells how many regions it has. */
class SweepRegions {
 public:
  /** Cuts the island in halves across its longest side, the halves again if it is large. @param pairs responses of the island's pairs */
  void find(const IslandAtHand& island, const IslandResponse& response, const std::vector<ResponsePair>& pairs);

  /** Regions, none if the island stays in one piece. */
  int count() const { return count_; }
  /** Region of a pair; count() if its bodies are of two of them. */
  int ofPair(const IslandResponse& response, const ResponsePair& pair) const;
  /** Region of a mover of the response. */
  int ofMover(int mover) const { return region_[mover]; }

 private:
  /** A mover that touches something. */
  struct Place {
    int mover;
    Vector3 point;  // [m]
  };
  void findPlaces(const IslandAtHand& island, const IslandResponse& response, const std::vector<ResponsePair>& pairs);
  void cut(std::size_t begin, std::size_t end, int levels);

  int count_ = 0;
  std::vector<int> region_;    // by mover
  std::vector<int> touching_;  // pairs, by mover
  std::vector<Place> places_;
};

}  // namespace blem_sim::dynamics
