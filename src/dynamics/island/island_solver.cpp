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
  if (fliesAlone()) return fly();
  made_joints_ = found_.terms.joints;
  made_loops_ = found_.terms.loops;
  newton_.start(*island_);
  steps_.start(*island_, &newton_);
  swept_.start(*island_, &newton_);
  heap_.start(*island_, &newton_, &steps_, &swept_);
  const double tolerance = island_->model.isHeap() ? HEAP_TOLERANCE * settings.gradient_tolerance : settings.gradient_tolerance;
  keepFirst(*island_);
  NewtonReport report;
  if (island_->model.isHeap() && heap_.stops(settings, &report)) return report;
  report.gradient = newton_.firstGradient(tolerance);
  if (report.gradient <= tolerance) {
    steps_.finish(settings, &report);
    return report;
  }
  report = island_->model.isSwept() ? heap_.solve(settings) : steps_.solvePredicted(settings);
  recoverFromFaults(settings, &report);
  return report;
}

bool IslandSolver::fliesAlone() const {
  const IslandTerms& terms = found_.terms;
  return terms.contacts.empty() && terms.joints.empty() && terms.loops.empty() && island_->model.mimics.empty();
}

// Nothing acts on the island but what its free momentum has: that gives its velocities.
NewtonReport IslandSolver::fly() {
  const IslandAtHand& island = *island_;
  SolverSpace& s = *island.space;
  setKinetic(island);
  forDofs(island, [&s](int k) { s.direction[k] = -s.kinetic[k]; });
  for (const int tree : island.model.trees) {
    factorTree({island.forest, tree, island.motion.mass}, &s.hessian);
    solveTree(island.forest, tree, s.hessian, &s.direction, &s.paths);
  }
  multiplyMass(island, s.direction, &s.mass_direction);
  forDofs(island, [&s](int k) {
    s.velocity[k] += s.direction[k];
    s.mass_velocity[k] = s.free_momentum[k] + (s.kinetic[k] + s.mass_direction[k]);
  });
  setScale(island);
  return {};
}

NewtonReport IslandSolver::solveAgain(const NewtonSettings& settings) {
  if (fliesAlone()) return fly();
  setKinetic(*island_);
  keepFirst(*island_);
  NewtonReport report = island_->model.isSwept() ? heap_.solve(settings) : steps_.solve(settings);
  recoverFromFaults(settings, &report);
  return report;
}

void IslandSolver::recoverFromFaults(const NewtonSettings& settings, NewtonReport* report) {
  const std::vector<ContactTerm>& contacts = found_.terms.contacts;
  const double most = island_->model.isSweptCrowd() ? faults(*report, contacts) : faultsWithCreep(*report, contacts);
  if (most > 1) last_resort_.recover(*island_, {&swept_, &newton_, &steps_}, settings, report);
}

bool IslandSolver::limitCorrections(double speed) {
  if (!boundCorrections(*island_, speed)) return false;
  forgetReactions();
  newton_.begin();
  return true;
}

// Stops and loops that held against those corrections would go on holding, and contacts against them, although nothing asks for it.
void IslandSolver::forgetReactions() {
  found_.terms.joints = made_joints_;
  for (std::size_t l = 0; l < made_loops_.size(); ++l) {
    LoopTerm& loop = found_.terms.loops[l];
    const Vector6 target = loop.target;
    loop = made_loops_[l];
    loop.target = target;
  }
}

}  // namespace blem_sim::dynamics
