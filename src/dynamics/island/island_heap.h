// Heaps: many bodies that push each other. Newton's method where it may succeed at its price, else sweeps, polished where they are quiet.
#pragma once

#include "newton/proximal_steps.h"
#include "sweeps/swept_island.h"

namespace blem_sim::dynamics {

class IslandHeap {
 public:
  void start(const IslandAtHand& island, NewtonLoop* newton, ProximalSteps* steps, SweptIsland* swept);
  /** Whether a large heap that hardly moves solves its step if it stops, with the impulses of the last one: then it does, and that is the
   *  answer. Else the velocities at hand are the first ones again. */
  bool stops(const NewtonSettings& settings, NewtonReport* report);
  NewtonReport solve(const NewtonSettings& settings);

 private:
  bool isLarge() const;
  bool sweepsWell() const;
  double fastestTurn() const;
  bool hardlyMoves() const;
  bool solveStanding(const NewtonSettings& settings, bool still, NewtonReport* report);
  bool solveFew(const NewtonSettings& settings, NewtonReport* report);
  void sweepAndPolish(const NewtonSettings& settings, NewtonReport* report);
  void sweepMixed(const NewtonSettings& settings, NewtonReport* report);
  void finishSwept(const NewtonSettings& settings, const NewtonReport& found, bool polishes, NewtonReport* report);
  SweepReport sweepOn(bool quiet);
  NewtonReport adoptSwept(int* sweeps);
  bool polish(const NewtonSettings& settings, const NewtonReport& swept, NewtonReport* report);

  const IslandAtHand* island_ = nullptr;
  NewtonLoop* newton_ = nullptr;
  ProximalSteps* steps_ = nullptr;
  SweptIsland* swept_ = nullptr;
};

}  // namespace blem_sim::dynamics
