// A solution of an island, to come back to if nothing better is found.
#pragma once

#include <vector>

#include "problem/island_at_hand.h"

namespace blem_sim::dynamics {

/** Velocities, contact impulses, and the joints' and loops' terms, whose proximal points give their impulses. */
class KeptSolution {
 public:
  /** Keeps the velocities in the space and the terms at hand. */
  void take(const IslandAtHand& island);
  /** Puts back what was kept. */
  void put(const IslandAtHand& island) const;

 private:
  std::vector<double> velocity_;  // of the trees' dofs in turn
  std::vector<Vector3> impulses_;
  std::vector<JointTerm> joints_;
  std::vector<LoopTerm> loops_;
};

}  // namespace blem_sim::dynamics
