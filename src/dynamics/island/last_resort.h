// Sweeps for an island that Newton's method and the heap's policy did not solve; if they fail, too, a bound on its energy.
#pragma once

#include "island/swept_island.h"
#include "problem/kept_solution.h"

namespace blem_sim::dynamics {

class LastResort {
 public:
  /**
   * Sweeps from the last step's impulses, and from none. Their results balance momentum and add no energy to free motion. The result of the
   * smallest faults is taken: one of theirs, or the one found before. If it has faults even so, the island's energy is bounded.
   * @param report of what was found before
   */
  void recover(const IslandAtHand& island, SweptIsland* swept, NewtonLoop* newton, NewtonReport* report);

 private:
  KeptSolution best_;
};

}  // namespace blem_sim::dynamics
