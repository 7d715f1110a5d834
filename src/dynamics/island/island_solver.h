// Solver of one island's step problem: Newton's method, sweeps for heaps, and what is left where neither helps. See docs/solver.md.
#pragma once

#include <memory>
#include <optional>

#include "island/island_heap.h"
#include "island/last_resort.h"
#include "newton/proximal_steps.h"

namespace blem_sim::dynamics {

/** Used again from step to step, so that it need not allocate. */
class IslandSolver {
 public:
  /**
   * Solves for space->velocity, which holds the first guess, space->mass_velocity M times it, with the terms that were made in terms().
   * The arguments must stay until the step's end.
   */
  NewtonReport solve(const Forest& forest, const ForestMotion& motion, const IslandModel& model, const NewtonSettings& settings,
                     SolverSpace* space);
  /** Goes on from the last solve's velocities after space->free_momentum has changed a little. */
  NewtonReport solveAgain(const NewtonSettings& settings);
  /**
   * After solve: contacts and loops that have added far more energy than moving the island at their speed takes are to correct less,
   * contacts that push hard nothing. Overwrites space->mass_direction.
   * @param speed [m/s] at which contacts correct depth at most
   * @return whether there were such: solveAgain solves the step with the rest of their corrections
   */
  bool limitCorrections(double speed);

  /** Threads that share the loops of the island, as long as they are gathered. */
  Team* team() { return team_.get(); }
  /** The island of the last solve. */
  const IslandAtHand& atHand() const { return *island_; }
  /** The answer to the last solve. */
  const IslandAnswer& found() const { return found_; }
  /** Terms of the island: before a solve to be made, after it those of the answer, for reactions that act beside the solve. */
  IslandTerms* terms() { return &found_.terms; }

 private:
  bool fliesAlone() const;
  NewtonReport fly();
  void forgetReactions();
  void recoverFromFaults(const NewtonSettings& settings, NewtonReport* report);

  std::optional<IslandAtHand> island_;
  IslandAnswer found_;
  std::vector<JointTerm> made_joints_;  // as they were before the solve
  std::vector<LoopTerm> made_loops_;
  std::unique_ptr<Team> team_ = std::make_unique<Team>();
  NewtonLoop newton_;
  ProximalSteps steps_;
  SweptIsland swept_;
  IslandHeap heap_;
  LastResort last_resort_;
};

}  // namespace blem_sim::dynamics
