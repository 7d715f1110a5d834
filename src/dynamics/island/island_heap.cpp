// Islands that are swept: many bodies that push each other, and islands that Newton's method did not solve.
#include <algorithm>
#include <cmath>

#include "island/island_problem.h"

namespace blem_sim::dynamics {
namespace {

constexpr int HEAP = 4;         // fewest free bodies of an island that is swept while it tumbles
constexpr int LARGE_HEAP = 32;  // fewest that are swept first; of fewer only if Newton's first iterations fail
constexpr double TURNS = 0.03;  // [rad/s] fastest turn of a heap that stands, slides or lands flat: Newton's method solves it
constexpr int FEW_ITERATIONS = 30, CROWD_ITERATIONS = 8;  // most of Newton's method on a small heap that tumbles, on a crowd at rest
constexpr double SETTLED = 1e-4;                          // of the largest impulse: largest change of one by a heap's last proximal step
// A heap tumbles if the first sweep changes impulses by more than this share of the largest. Sweeps end when they change impulses by less;
// a quiet crowd sways for ever if they leave more.
constexpr double TUMBLES = 1e-2, SWEPT = 1e-3, SWEPT_FEW = 2e-5, SWEPT_QUIET = 1e-5, RECOVERED = 1e-7;
constexpr int FEW_SWEEPS = 60, MOST_SWEEPS = 240;
// Newton's method on a crowd fails where one sweep changes impulses by more than this share of the largest: the hard problem, and
// polishing.
constexpr double LIKE_BEFORE = 1e-6, NEARLY = 1e-4;
// Softness of contacts while a quiet heap is polished: stiffer ones change their kinds too often.
constexpr double POLISH_SOFTNESS = 300, KEPT_SOFTNESS = 100, INEXACT_POLISH = 0.02;
constexpr int POLISH_WORK = 6000, FEWEST_POLISHES = 10, MOST_POLISHES = 60;  // iterations times trees
constexpr double BALANCED = 1e-5;                                            // [rad/s or m/s] most that a step may miss momentum's balance
constexpr double RESIDUAL_IS_TROUBLE = 0.01;                                 // of the largest impulse
constexpr double CREEP_IS_TROUBLE = 0.01;                                    // [rad/s or m/s]
constexpr int MOTOR_ROUNDS = 4;                                              // searches for the motors that are at their bounds
constexpr double FREE_ENERGY = 1e-9, GAIN_OF_MOTION = 1e-6;  // [J], and of the work that contacts exchange: most that sweeps may gain

}  // namespace

int IslandProblem::treeCount() const { return static_cast<int>(trees.size()); }

bool IslandProblem::isCrowd() const { return treeCount() > CROWD; }

bool IslandProblem::isHeap() const { return treeCount() >= HEAP && loops.empty() && mimics.empty() && joints.empty(); }

SweepProblem IslandProblem::sweepProblem() const {
  return {*forest_, *motion_, trees, patches, contacts, joints, loops, loop_pairs, mimics, space_->free_momentum, up, team_.get()};
}

double IslandProblem::largestImpulse() const {
  double largest = 0;
  for (const ContactTerm& c : contacts) largest = std::max(largest, c.impulse.squaredNorm());
  return std::sqrt(largest);
}

// Imbalance, creep of joints and violation of Coulomb's law, the worst of them in units of its bound. Infinite if one is not a number.
double IslandProblem::faults(const NewtonReport& report) const {
  const double contact = report.contact_residual > 0 ? report.contact_residual / (RESIDUAL_IS_TROUBLE * largestImpulse()) : 0;
  const double worst = std::max({report.imbalance / BALANCED, report.joint_creep / CREEP_IS_TROUBLE, contact});
  return std::isfinite(report.imbalance + report.joint_creep + report.contact_residual) ? worst : INFINITY;
}

// Creep of contacts among them: light bodies between heavy ones creep long before they violate the law by much of the largest impulse.
double IslandProblem::faultsWithCreep(const NewtonReport& report) const {
  return std::max(faults(report), report.contact_creep / CREEP_IS_TROUBLE);
}

void IslandProblem::takeFirstVelocity() {
  SolverSpace& s = *space_;
  forDofs([&s](int k) { s.velocity[k] = s.first_velocity[k]; });
}

// The velocities and the terms' impulses at hand become the iterate. Its imbalance is that of motors and friction.
void IslandProblem::adoptImpulses() {
  SolverSpace& s = *space_;
  for (const int tree : trees) {
    multiply(*forest_, tree, motion_->mass, s.velocity, &s.mass_velocity, &s.paths);
    const ForestTree& t = forest_->trees()[tree];
    for (int k = t.first_dof; k < t.dof_end; ++k) s.kinetic[k] = s.mass_velocity[k] - s.free_momentum[k];
  }
  begin();
  for (const ContactPatch& p : patches)
    for (int i = p.first; i < p.end; ++i)
      for (int axis = 0; axis < 3; ++axis)
        contact_blocks_[p.first_block + (i - p.first) / LANES].impulse[axis][(i - p.first) % LANES] = contacts[i].impulse[axis];
  blem_sim::dynamics::remember(contact_blocks_.data(), contact_blocks_.data() + contact_blocks_.size());
  double first = 0, second = 0;
  blem_sim::dynamics::respond(0, joint_blocks_.data(), joint_blocks_.data() + joint_blocks_.size(), &first, &second);
  responses_known_ = true;
  evaluateGradient();
  for (const int k : idle_dofs_) s.gradient[k] = s.kinetic[k];
  forIdleJoints([&](JointBlock* b, int lane, int dof) { s.gradient[dof] -= b->impulse[lane]; });
  gradient_norm_ = std::max(gradientNorm(live_dofs_), gradientNorm(idle_dofs_));
}

// Kinetic energy that the contacts' impulses add to that of free motion, correction of depth left out. Exact impulses never add any.
// Precondition: adoptImpulses.
ContactWork IslandProblem::contactWork() {
  ContactWork work;
  sweeps_.freeVelocity(&space_->direction);
  setSteps(space_->direction);
  for (const ContactPatch& p : patches) {
    for (int i = p.first; i < p.end; ++i) {
      const ContactBlock& b = contact_blocks_[p.first_block + (i - p.first) / LANES];
      const int lane = (i - p.first) % LANES;
      for (int axis = 0; axis < 3; ++axis) {
        const double g = b.impulse[axis][lane], after = b.velocity[axis][lane], free = b.step[axis][lane] + contacts[i].bend[axis];
        work.gained += 0.5 * g * (after + free) - g * std::max(0.0, contacts[i].target) * contacts[i].normal[axis];
        work.exchanged += 0.5 * std::abs(g * (after + free));
        work.change += g * (after - free);
      }
    }
  }
  return work;
}

bool IslandProblem::sweepFrom(SweepStart start, SweepReport* report) {
  SolverSpace& s = *space_;
  takeFirstVelocity();
  const SweepProblem problem = sweepProblem();
  if (!sweeps_.load(problem, start, &s.velocity)) return false;
  *report = sweeps_.sweep(MOST_SWEEPS, RECOVERED, &s.velocity);
  for (int round = 1; round < MOTOR_ROUNDS && !sweeps_.motorsAgree(s.velocity); ++round) {
    sweeps_.read(s.velocity, &contacts, &joints, &loops);
    for (ContactTerm& c : contacts) c.previous = c.impulse;
    if (!sweeps_.load(problem, SweepStart::PREVIOUS, &s.velocity)) return false;
    report->sweeps += sweeps_.sweep(MOST_SWEEPS, RECOVERED, &s.velocity).sweeps;
  }
  return true;
}

void IslandProblem::adoptSwept() {
  sweeps_.read(space_->velocity, &contacts, &joints, &loops);
  adoptImpulses();
  const ContactWork work = contactWork();
  const double bound = FREE_ENERGY + GAIN_OF_MOTION * work.exchanged;
  if (work.gained <= bound) return;
  // Impulses a times as large gain a (first + a second): the factor a makes this gain nothing.
  const double second = 0.5 * work.change, first = work.gained - second;
  sweeps_.scale(second > 0 ? std::clamp(-first / second, 0.0, 1.0) : 0, &space_->velocity);
  sweeps_.read(space_->velocity, &contacts, &joints, &loops);
  adoptImpulses();
}

void IslandProblem::finishSwept(NewtonReport* report) {
  const int iterations = report->iterations;
  assess(report);
  report->iterations = iterations;
  readMimics();
  readTerms();
}

// Newton's method on a heap that is nearly at rest, from the swept impulses. @return whether its result is better and was taken
bool IslandProblem::polish(const NewtonSettings& settings, NewtonReport* report) {
  NewtonReport swept, polished;
  assess(&swept);
  NewtonSettings few = settings;
  few.max_iterations = std::clamp(POLISH_WORK / treeCount(), FEWEST_POLISHES, MOST_POLISHES);
  soften(POLISH_SOFTNESS, 1);
  predict();
  polished.iterations = 1 + newton(few, INEXACT_POLISH, few.max_iterations);
  slip_mixing_.start(contact_blocks_.size() * LANES);
  remember();
  soften(KEPT_SOFTNESS, 1);
  polished.iterations += newton(few, INEXACT_POLISH, std::max(0, few.max_iterations - polished.iterations));
  finish(few, &polished);
  const int iterations = report->iterations + polished.iterations;
  const bool better = polished.imbalance <= BALANCED && polished.contact_residual < swept.contact_residual;
  if (better) *report = polished;
  report->iterations = iterations;
  return better;
}

// Contacts of a heap that turns slowly hardly ever change their kinds: a tower, a wall, a heap at rest, a stack that slides.
bool IslandProblem::turnsSlowly() const {
  double fastest = 0;
  for (const int tree : trees)
    fastest = std::max(fastest, space_->first_velocity.segment<3>(forest_->trees()[tree].first_dof).squaredNorm());
  return fastest <= TURNS * TURNS;
}

// Impulses are settled when the last proximal step changed none of them by more than SETTLED. Residuals alone do not tell: each contact of
// a tower that leans misses Coulomb's law by little, but together they let it sway.
bool IslandProblem::isSettled() const {
  double change = 0, largest = 0;
  for (const ContactBlock& b : contact_blocks_) {
    for (int lane = 0; lane < LANES; ++lane) {
      double changed = 0, impulse = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double g = b.impulse[axis][lane], by = g - b.previous[axis][lane];
        changed += by * by;
        impulse += g * g;
      }
      change = std::max(change, changed);
      largest = std::max(largest, impulse);
    }
  }
  return change <= SETTLED * SETTLED * largest;
}

// Keeps the best proximal step of a heap that balanced momentum, since the budget may end at any step.
void IslandProblem::keepBalanced(const NewtonReport& report, double* least) {
  if (!isHeap() || !(report.imbalance <= BALANCED) || !(report.contact_residual < *least)) return;
  *least = report.contact_residual;
  readTerms();
  kept_.take(space_->velocity, trees, *forest_, contacts, joints, loops);
}

void IslandProblem::returnToBalanced(double least, NewtonReport* report) {
  if (report->imbalance <= BALANCED || !std::isfinite(least)) return;
  kept_.put(trees, *forest_, &space_->velocity, &contacts, &joints, &loops);
  adoptImpulses();
  assess(report);
}

bool IslandProblem::isExact(const NewtonSettings& settings, const NewtonReport& report) const {
  return report.contact_residual <= settings.contact_tolerance && gradient_norm_ <= settings.gradient_tolerance;
}

// Solves the hard problem alone, in few iterations: for a few bodies that tumble, but move much as in the step before, or for a crowd at
// rest. A crowd's result must be exact: the least imbalance would set it in motion again.
bool IslandProblem::solveFew(const NewtonSettings& settings, NewtonReport* report) {
  NewtonSettings few = settings;
  few.max_iterations = isCrowd() ? CROWD_ITERATIONS : FEW_ITERATIONS;
  predict();
  report->iterations = 1 + newton(few, 0, few.max_iterations, FIRST_ITERATIONS);
  if (gradient_norm_ > few.gradient_tolerance) return false;
  finish(few, report);
  return isCrowd() ? isExact(settings, *report) : faults(*report) <= 1;
}

bool IslandProblem::solveStanding(const NewtonSettings& settings, NewtonReport* report) {
  predict();
  *report = iterate(settings);
  ++report->iterations;
  return faults(*report) <= 1;
}

// Whether the last step's impulses nearly solve this one: one sweep tells.
bool IslandProblem::isLikeBefore() {
  Eigen::VectorXd* velocity = &space_->direction;
  return sweeps_.load(sweepProblem(), SweepStart::PREVIOUS, velocity) && sweeps_.sweep(1, 0, velocity).first_change <= LIKE_BEFORE;
}

// Runs Newton's method where it may succeed at its price. @return whether it did
bool IslandProblem::solveWithoutSweeps(const NewtonSettings& settings, NewtonReport* report) {
  if (!turnsSlowly()) return treeCount() < LARGE_HEAP && solveFew(settings, report);
  return isCrowd() ? isLikeBefore() && solveFew(settings, report) : solveStanding(settings, report);
}

NewtonReport IslandProblem::solveHeap(const NewtonSettings& settings) {
  NewtonReport report;
  if (!solveWithoutSweeps(settings, &report)) sweepAndPolish(settings, &report);
  return report;
}

void IslandProblem::sweepAndPolish(const NewtonSettings& settings, NewtonReport* report) {
  SolverSpace& s = *space_;
  takeFirstVelocity();
  const SweepProblem problem = sweepProblem();
  if (!sweeps_.load(problem, SweepStart::PREVIOUS, &s.velocity)) return;
  const double first_change = sweeps_.sweep(1, 0, &s.velocity).first_change;
  const bool quiet = first_change <= TUMBLES;
  const SweepReport swept = quiet ? sweeps_.sweep(isCrowd() ? MOST_SWEEPS : FEW_SWEEPS, isCrowd() ? SWEPT_QUIET : 0, &s.velocity)
                                  : sweeps_.sweep(MOST_SWEEPS, treeCount() < LARGE_HEAP ? SWEPT_FEW : SWEPT, &s.velocity);
  report->iterations += 1 + swept.sweeps;
  adoptSwept();
  NewtonReport found;
  assess(&found);
  // Light pushes may creep though they change by little of the largest one.
  if (found.contact_creep > CREEP_IS_TROUBLE) {
    report->iterations += sweeps_.sweep(MOST_SWEEPS, SWEPT_FEW, &s.velocity).sweeps;
    adoptSwept();
    assess(&found);
  }
  // Sweeps do not converge in towers, where a push has a long way to go.
  const bool worthwhile = isCrowd() ? first_change <= NEARLY : quiet || swept.last_change > SWEPT;
  if (worthwhile && !isExact(settings, found)) {
    if (polish(settings, report)) return;
    sweeps_.scale(1, &s.velocity);
    adoptSwept();
  }
  finishSwept(report);
}

// Sweeps from the last step's impulses, and from none. Their results balance momentum and add no energy to free motion. The result of the
// smallest faults is taken: one of theirs, or the one found before.
void IslandProblem::recover(NewtonReport* report) {
  SolverSpace& s = *space_;
  double least = faultsWithCreep(*report);
  kept_.take(s.velocity, trees, *forest_, contacts, joints, loops);
  for (const SweepStart start : {SweepStart::PREVIOUS, SweepStart::NOTHING}) {
    NewtonReport swept;
    SweepReport sweeps;
    if (!sweepFrom(start, &sweeps)) break;
    report->iterations += sweeps.sweeps;
    adoptSwept();
    finishSwept(&swept);
    const double left = faultsWithCreep(swept);
    if (left < least) kept_.take(s.velocity, trees, *forest_, contacts, joints, loops);
    least = std::min(least, left);
    if (least <= 1) break;
  }
  kept_.put(trees, *forest_, &s.velocity, &contacts, &joints, &loops);
  adoptImpulses();
  finishSwept(report);
  if (least > 1) boundEnergy();
}

}  // namespace blem_sim::dynamics
