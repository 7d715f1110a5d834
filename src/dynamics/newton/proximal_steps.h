// Proximal steps: each solves the problem about a proximal point, which then moves to the solution, until Coulomb's law holds.
#pragma once

#include "newton/newton_loop.h"
#include "problem/kept_solution.h"

namespace blem_sim::dynamics {

class ProximalSteps {
 public:
  void start(const IslandAtHand& island, NewtonLoop* newton);
  /** Solves from the iterate at hand: the hard problem, or soft ones that lead to it; then proximal steps until the law holds. */
  NewtonReport solve(const NewtonSettings& settings);
  /** The same from the iterate that a first step as if all went on as it was leads to. */
  NewtonReport solvePredicted(const NewtonSettings& settings);
  /** The same, but one proximal step is enough where impulses are nearly the last time step's: that led here, and the next one leads on. */
  NewtonReport solveNext(const NewtonSettings& settings);
  /** The same as solve from the iterate at hand with softer contacts alone, for crowds: stiff ones change their kinds in many dear
   * iterations. */
  NewtonReport solveSoftened(const NewtonSettings& settings);
  /** Goes on from an iterate until momentum, joints and Coulomb's law hold, and reads the answer. @param report of what led to it */
  void finish(const NewtonSettings& settings, NewtonReport* report);

 private:
  bool solveHard(const NewtonSettings& settings, int patience, NewtonReport* report);
  void solveSoft(const NewtonSettings& settings, NewtonReport* report);
  void runSoftened(double contact, double joint, const NewtonSettings& settings, NewtonReport* report);
  bool isLawful(const NewtonSettings& settings, const NewtonReport& report) const;
  void keepBalanced(const NewtonReport& report, double* least);
  void returnToBalanced(double least, NewtonReport* report);

  const IslandAtHand* island_ = nullptr;
  NewtonLoop* newton_ = nullptr;
  KeptSolution balanced_;  // the best step of a heap that balanced momentum
};

}  // namespace blem_sim::dynamics
