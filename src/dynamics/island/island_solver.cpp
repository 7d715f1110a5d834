#include "island/island_solver.h"

#include "island/island_bounds.h"
#include "newton/island_faults.h"
#include "problem/island_velocity.h"

namespace blem_sim::dynamics {
namespace {

constexpr double HEAP_TOLERANCE = 100;  // times the gradient's tolerance: of a heap that goes on as it did

}  // namespace

NewtonReport IslandSolver::solve(const Forest& forest, const ForestMotion& motion, const IslandModel& model, const NewtonSettings& settings,
                                 SolverSpace* space) {
  found_.mimic_impulses.clear();
  island_.emplace(IslandAtHand{forest, motion, model, &found_, space, team_.get()});
  newton_.start(*island_);
  steps_.start(*island_, &newton_);
  swept_.start(*island_, &newton_);
  heap_.start(*island_, &newton_, &steps_, &swept_);
  const double tolerance = island_->model.isHeap() ? HEAP_TOLERANCE * settings.gradient_tolerance : settings.gradient_tolerance;
  NewtonReport report;
  report.gradient = newton_.firstGradient(tolerance);
  if (report.gradient <= tolerance) {
    steps_.finish(settings, &report);
    return report;
  }
  keepFirst(*island_);
  report = isSwept() ? heap_.solve(settings) : steps_.solvePredicted(settings);
  recoverFromFaults(settings, &report);
  return report;
}

NewtonReport IslandSolver::solveAgain(const NewtonSettings& settings) {
  setKinetic(*island_);
  keepFirst(*island_);
  NewtonReport report = isSwept() ? heap_.solve(settings) : steps_.solve(settings);
  recoverFromFaults(settings, &report);
  return report;
}

void IslandSolver::recoverFromFaults(const NewtonSettings& settings, NewtonReport* report) {
  if (faults(*report, found_.terms.contacts) > 1) last_resort_.recover(*island_, {&swept_, &newton_, &steps_}, settings, report);
}

bool IslandSolver::limitCorrections(double speed) {
  if (!boundCorrections(*island_, speed)) return false;
  newton_.begin();
  return true;
}

}  // namespace blem_sim::dynamics
