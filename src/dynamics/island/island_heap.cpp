#include "island/island_heap.h"

#include <algorithm>
#include <cmath>

#include "newton/island_faults.h"
#include "problem/island_velocity.h"

namespace blem_sim::dynamics {
namespace {

constexpr int LARGE_HEAP = 32;  // fewest whose contacts are softened while they stand
constexpr double UNEVEN = 10;   // heaviest over lightest body of a small heap that sweeps do not solve: Newton's method does
constexpr double TURNS = 0.03;  // [rad/s] fastest turn of a heap that stands, slides or lands flat: Newton's method solves it
constexpr double STILL = 1e-4;  // [rad/s] fastest turn of a crowd whose contacts keep their kinds
constexpr double STOPS = 1e-6;  // [rad/s or m/s] fastest dof of a large heap that may stop
constexpr int FEW_ITERATIONS = 30, CROWD_ITERATIONS = 8;  // most of Newton's method on a mixed heap that tumbles, on a mixed crowd
// Proximal steps of a crowd that stands, and of a large heap in which something turns: it misses the tolerance after twelve as well.
constexpr int FEW_STEPS = 3;
// A heap tumbles if the first sweep changes impulses by more than this share of the largest. Sweeps end when they change impulses by less;
// a quiet crowd sways for ever if they leave more, and motors of robots in a heap push as hard as the largest impulse.
constexpr double TUMBLES = 1e-2, SWEPT = 1e-3, SWEPT_SMALL = 1e-4, SWEPT_MIXED = 1e-4, SWEPT_FEW = 2e-5, SWEPT_QUIET = 1e-5;
constexpr double STANDING = 100;  // times the gradient's tolerance: of a large heap that stands, whose next step goes on from there
constexpr int FEW_SWEEPS = 30, CROWD_SWEEPS = 100;  // most of a quiet heap, which Newton's method polishes, and of a quiet crowd
constexpr double NEARLY = 1e-4;                     // change of impulses by the first sweep, beyond which a large heap is not at rest
// Softness of contacts while a quiet heap is polished: stiffer ones change their kinds too often.
constexpr double POLISH_SOFTNESS = 300, KEPT_SOFTNESS = 100, INEXACT_POLISH = 0.02;
constexpr int POLISH_WORK = 6000, FEWEST_POLISHES = 10, MOST_POLISHES = 60;  // iterations times trees

NewtonSettings inFewSteps(NewtonSettings settings) {
  settings.max_outer = std::min(settings.max_outer, FEW_STEPS);
  return settings;
}

NewtonSettings standing(NewtonSettings settings) {
  settings.gradient_tolerance *= STANDING;
  return inFewSteps(settings);
}

}  // namespace

void IslandHeap::start(const IslandAtHand& island, NewtonLoop* newton, ProximalSteps* steps, SweptIsland* swept) {
  island_ = &island;
  newton_ = newton;
  steps_ = steps;
  swept_ = swept;
}

NewtonReport IslandHeap::solve(const NewtonSettings& settings) {
  NewtonReport report;
  if (island_->model.isMixedHeap()) {
    if (!solveFew(settings, &report)) sweepMixed(settings, &report);
  } else {
    const double turn = fastestTurn();
    const bool newton_alone = turn <= TURNS || (!isLarge() && !sweepsWell());
    if (!newton_alone || !solveStanding(settings, turn <= STILL, &report)) sweepAndPolish(settings, &report);
  }
  return report;
}

bool IslandHeap::isLarge() const { return island_->model.treeCount() >= LARGE_HEAP; }

/** Whether sweeps take few rounds: among free bodies of like masses. */
bool IslandHeap::sweepsWell() const {
  double lightest = INFINITY, heaviest = 0;
  for (const int tree : island_->model.trees) {
    const ForestTree& t = island_->tree(tree);
    const double mass = island_->motion.composite[t.first_node].mass;
    lightest = std::min(lightest, mass);
    heaviest = t.free && t.dofCount() == 6 ? std::max(heaviest, mass) : INFINITY;
  }
  return heaviest <= UNEVEN * lightest;
}

/** [rad/s] of the body that turns fastest. */
double IslandHeap::fastestTurn() const {
  double fastest = 0;
  for (const int tree : island_->model.trees)
    fastest = std::max(fastest, island_->space->first_velocity.segment<3>(island_->tree(tree).first_dof).squaredNorm());
  return std::sqrt(fastest);
}

bool IslandHeap::hardlyMoves() const {
  double fastest = 0;
  forDofs(*island_, [&](int k) { fastest = std::max(fastest, std::abs(island_->space->first_velocity[k])); });
  return fastest <= STOPS;
}

// A heap that settles creeps on for long by what each step misses of Coulomb's law. It need not: it is at rest before.
bool IslandHeap::stops(const NewtonSettings& settings, NewtonReport* report) {
  if (!isLarge() || !hardlyMoves()) return false;
  SolverSpace& s = *island_->space;
  for (ContactTerm& c : island_->terms()->contacts) c.impulse = c.previous;
  forDofs(*island_, [&s](int k) { s.velocity[k] = 0; });
  report->iterations = 1;
  report->gradient = newton_->adopt();
  newton_->finish(report);
  if (isExact(standing(settings), *report)) return true;
  returnToFirst(*island_);
  multiplyMass(*island_, s.velocity, &s.mass_velocity);
  newton_->begin();
  return false;
}

// Contacts of a heap that turns slowly hardly ever change their kinds: a tower, a wall, a heap at rest, a stack that slides. Newton's
// method alone solves it. Those of a large heap that settles do change: softer ones take half as many iterations. A crowd that is still
// changes so little from step to step that it has settled sooner with a proximal step each than with three. @return whether it is solved
bool IslandHeap::solveStanding(const NewtonSettings& settings, bool still, NewtonReport* report) {
  if (isLarge() && !still)
    *report = steps_->solveSoftened(standing(settings));
  else if (island_->model.isCrowd())
    *report = steps_->solveNext(standing(settings));
  else
    *report = steps_->solvePredicted(settings);
  return faultsWithCreep(*report, island_->terms()->contacts) <= 1;
}

// Solves a mixed heap's hard problem alone, in few iterations: it may move much as in the step before. A crowd's result must be exact:
// the least imbalance would set it in motion again.
bool IslandHeap::solveFew(const NewtonSettings& settings, NewtonReport* report) {
  const bool crowd = island_->model.isCrowd();
  NewtonSettings few = settings;
  few.max_iterations = crowd ? CROWD_ITERATIONS : FEW_ITERATIONS;
  newton_->predict();
  const NewtonRun run = newton_->run({few.gradient_tolerance, 0, few.max_iterations, FIRST_ITERATIONS});
  report->iterations = 1 + run.iterations;
  report->gradient = run.gradient;
  if (run.gradient > few.gradient_tolerance) return false;
  steps_->finish(few, report);
  return crowd ? isExact(settings, *report) : faultsWithCreep(*report, island_->terms()->contacts) <= 1;
}

void IslandHeap::sweepAndPolish(const NewtonSettings& settings, NewtonReport* report) {
  if (!swept_->load(SweepStart::PREVIOUS)) return;
  const double first_change = swept_->sweep(1, 0).first_change;
  const bool quiet = first_change <= TUMBLES;
  const SweepReport sweeps = sweepOn(quiet);
  report->iterations += 1 + sweeps.sweeps;
  const NewtonReport found = adoptSwept(&report->iterations);
  const bool nearly = first_change <= NEARLY;
  // Sweeps do not converge in towers, where a push has a long way to go.
  const bool faulty = sweeps.last_change > SWEPT || faultsWithCreep(found, island_->terms()->contacts) > 1;
  const bool polishes = !island_->model.isCrowd() && (quiet || faulty);
  finishSwept(isLarge() && !nearly ? inFewSteps(settings) : settings, found, polishes, report);
}

void IslandHeap::finishSwept(const NewtonSettings& settings, const NewtonReport& found, bool polishes, NewtonReport* report) {
  if (polishes && !isExact(settings, found)) {
    if (polish(settings, found, report)) return;
    swept_->adoptAgain();
  }
  newton_->finish(report);
}

// Sweeps with motors of robots find what gives way; where it is quiet, or they leave faults, Newton's method goes on.
void IslandHeap::sweepMixed(const NewtonSettings& settings, NewtonReport* report) {
  SweepReport sweeps;
  const double enough = isLarge() ? SWEPT_MIXED : SWEPT_FEW;
  if (!swept_->sweepWithMotors(SweepStart::PREVIOUS, enough, &sweeps)) return;
  report->iterations += sweeps.sweeps;
  const NewtonReport found = adoptSwept(&report->iterations);
  const bool faulty = faultsWithCreep(found, island_->terms()->contacts) > 1;
  finishSwept(settings, found, faulty || sweeps.first_change <= TUMBLES, report);
}

SweepReport IslandHeap::sweepOn(bool quiet) {
  const bool crowd = island_->model.isCrowd();
  if (quiet) return swept_->sweep(crowd ? CROWD_SWEEPS : FEW_SWEEPS, crowd ? SWEPT_QUIET : 0);
  return swept_->sweep(SweptIsland::MOST_SWEEPS, isLarge() ? SWEPT : SWEPT_SMALL);
}

// Light pushes may creep though they change by little of the largest one: they are swept on. @param sweeps to which those are added
NewtonReport IslandHeap::adoptSwept(int* sweeps) {
  NewtonReport found;
  found.gradient = swept_->adopt();
  assess(*island_, newton_->iterate(), &found);
  if (!(found.contact_creep > CREEP_IS_TROUBLE)) return found;
  *sweeps += swept_->sweep(SweptIsland::MOST_SWEEPS, SWEPT_FEW).sweeps;
  found.gradient = swept_->adopt();
  assess(*island_, newton_->iterate(), &found);
  return found;
}

// Newton's method on a heap that is nearly at rest, from the swept impulses. @return whether its result is better and was taken
bool IslandHeap::polish(const NewtonSettings& settings, const NewtonReport& swept, NewtonReport* report) {
  NewtonSettings few = settings;
  few.max_iterations = std::clamp(POLISH_WORK / island_->model.treeCount(), FEWEST_POLISHES, MOST_POLISHES);
  NewtonReport polished;
  newton_->soften(POLISH_SOFTNESS, 1);
  newton_->predict();
  polished.iterations = 1 + newton_->run({few.gradient_tolerance, INEXACT_POLISH, few.max_iterations}).iterations;
  newton_->rememberUnmixed();
  newton_->soften(KEPT_SOFTNESS, 1);
  const NewtonRun run = newton_->run({few.gradient_tolerance, INEXACT_POLISH, std::max(0, few.max_iterations - polished.iterations)});
  polished.iterations += run.iterations;
  polished.gradient = run.gradient;
  steps_->finish(few, &polished);
  const int iterations = report->iterations + polished.iterations;
  const bool better = polished.imbalance <= BALANCED && polished.contact_residual < swept.contact_residual;
  if (better) *report = polished;
  report->iterations = iterations;
  return better;
}

}  // namespace blem_sim::dynamics
