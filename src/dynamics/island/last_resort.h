// For an island that Newton's method and the heap's policy did not solve: more proximal steps, then sweeps; if they fail, too, a bound on
// its energy.
#pragma once

#include "newton/proximal_steps.h"
#include "problem/kept_solution.h"
#include "sweeps/swept_island.h"

namespace blem_sim::dynamics {

/** The ways to solve an island. */
struct IslandWays {
  SweptIsland* swept;
  NewtonLoop* newton;
  ProximalSteps* steps;
};

class LastResort {
 public:
  /**
   * Unless the island is a crowd that is swept, proximal steps go on from where its iterations ended, with slips that move by ever less of
   * what they are off. Then sweeps from the last step's impulses, and from none; each time Newton's method goes on from what they found.
   * The result of sweeps balances momentum and adds no energy to free motion. The result of the smallest faults is taken: one of these, or
   * the one found before. If it has faults even so, the island's energy is bounded. Contacts that creep and nothing else are not swept.
   * @param report of what was found before
   */
  void recover(const IslandAtHand& island, const IslandWays& ways, const NewtonSettings& settings, NewtonReport* report);

 private:
  void goOn(const IslandAtHand& island, const IslandWays& ways, const NewtonSettings& settings, NewtonReport* report);
  void sweep(const IslandAtHand& island, const IslandWays& ways, const NewtonSettings& settings, NewtonReport* report);
  void take(const IslandAtHand& island, const NewtonReport& found);
  int polish(const IslandAtHand& island, const IslandWays& ways, const NewtonSettings& settings);

  KeptSolution best_;
  double least_ = 0;  // faults of the best
};

}  // namespace blem_sim::dynamics
