#include <algorithm>
#include "island/island_problem.h"

namespace blem_sim::dynamics {
namespace {

constexpr int MAX_LINE_SEARCH = 30;
constexpr double LINE_SEARCH_SLOPE = 1e-3;  // of the first slope: below it the search is near enough to its minimum
// Shares of a proximal step's first gradient: the next step changes the problem again, so this one need not be solved to the last digit.
constexpr double INEXACT = 0.02, INEXACT_MIXED = 1e-4;  // mixed slips begin far away: a miss that is to lead on must not be the rest
// Proximal weights of the first steps against the last one's: soft contacts and soft joint friction find in few iterations which contacts
// and joints stick.
constexpr int SOFT_STAGES = 2;
constexpr double CONTACT_SOFTNESS[SOFT_STAGES] = {1000, 30};
constexpr double JOINT_SOFTNESS[SOFT_STAGES] = {10, 3};
constexpr double FIRST_PROGRESS = 0.1;      // an iteration that leads somewhere reduces the gradient to this
constexpr double CHORD_PROGRESS = 0.1;      // a factor that is not made anew must have reduced the gradient to this
constexpr int EASY = 10, ENOUGH_LEFT = 20;  // iterations of a proximal step whose slips are mixed, and of those that are left then
// Contacts of a light body between heavy ones still creep so fast after the proximal steps that suffice elsewhere: they
// get more, as long as a step takes an iteration.
constexpr double CREEPS = 1e-3;          // [m/s]
constexpr int ENOUGH_TO_END = 30;        // iterations that are left for a last step
constexpr double OF_FIRST_SPEED = 1e-3;  // creep of contacts that is none: of the fastest of them before the solve
constexpr double HEAP_TOLERANCE = 100;   // times the gradient's tolerance: of a heap that goes on as it did
constexpr double NO_STEP = 1e-16;        // [rad/s or m/s] largest change of a velocity that is none

}  // namespace

void IslandProblem::evaluateGradient() {
  evaluate();
  gradient();
  foldGradient();
}

// Makes the first step: as if contacts, friction and limits went on as they were when the last step ended, linear though they are not.
void IslandProblem::predict() {
  forContactRanges([](std::size_t, ContactBlock* first, ContactBlock* end) { expect(first, end); });
  for (std::size_t b = 0; b < joint_blocks_.size(); ++b)
    for (int lane = 0; lane < LANES; ++lane) expect(termOf(static_cast<int>(b), lane), lane, &joint_blocks_[b]);
  responses_known_ = true;
  if (!anchor()) return;
  evaluateGradient();
  if (!factor()) return;
  findDirection();
  setDirection();
  move(1);
  responses_known_ = false;
}

// Changes along the direction: of momenta on live dofs, of relative velocities of contacts, joints and loops.
void IslandProblem::setDirection() {
  SolverSpace& s = *space_;
  for (const int tree : trees) multiply(*forest_, tree, s.idle.rows, s.direction, &s.mass_direction, &s.paths, &s.live);
  setSteps(s.direction);
}

// Slope of the objective at a along the direction, and its derivative.
PotentialSlope IslandProblem::slope(double a) {
  PotentialSlope slope = respond(a);
  slope.first += linear_ + a * quadratic_;
  slope.second += quadratic_;
  for (const LoopTerm& loop : loops) {
    for (int r = 0; r < 6; ++r) {
      const double d = loop.step[r], v = loop.velocity[r] + a * d;
      slope.first -= loop.impulse(r, v) * d;
      slope.second += loop.stiffness(r, v) * d * d;
    }
  }
  return slope;
}

double IslandProblem::lineSearch() {
  const SolverSpace& s = *space_;
  setDirection();
  linear_ = quadratic_ = 0;
  double start = 0;
  for (const int k : live_dofs_) {
    quadratic_ += s.direction[k] * s.mass_direction[k];
    linear_ += s.direction[k] * s.kinetic[k];
    start += s.direction[k] * s.gradient[k];
  }
  double low = 0, high = -1, a = 1;
  for (int it = 0; it < MAX_LINE_SEARCH; ++it) {
    const PotentialSlope here = slope(a);
    if (std::abs(here.first) <= LINE_SEARCH_SLOPE * std::abs(start)) break;
    (here.first < 0 ? low : high) = a;
    double next = a - here.first / here.second;
    if (high > 0 && !(next > low && next < high)) next = 0.5 * (low + high);
    if (high < 0 && !(next > low)) next = 2 * a;
    if (next == a) break;
    a = next;
  }
  return a;
}

double IslandProblem::gradientNorm(const std::vector<int>& dofs) const {
  double worst = 0;
  for (const int k : dofs) worst = std::max(worst, std::abs(space_->gradient[k]) * space_->scale[k]);
  return worst;
}

// Largest gradient of a dof, over the dof's own inertia: a velocity.
double IslandProblem::imbalance() const {
  double worst = 0;
  for (const int tree : trees)
    for (int k = forest_->trees()[tree].first_dof; k < forest_->trees()[tree].dof_end; ++k)
      worst = std::max(worst, std::abs(space_->gradient[k]) * space_->scale[k] * space_->scale[k]);
  return worst;
}

// Moves by a along the direction. Returns the largest change of a velocity.
double IslandProblem::move(double a) {
  SolverSpace& s = *space_;
  double moved = 0;
  for (const int k : live_dofs_) {
    s.velocity[k] += a * s.direction[k];
    s.kinetic[k] += a * s.mass_direction[k];
    moved = std::max(moved, std::abs(a * s.direction[k]));
  }
  takeSteps(a);
  for (int b = 0; b < live_joint_blocks_; ++b)
    for (int lane = 0; lane < LANES; ++lane) joint_blocks_[b].velocity[lane] += a * joint_blocks_[b].step[lane];
  for (LoopTerm& loop : loops) loop.velocity += a * loop.step;
  responses_known_ = a == responses_at_;
  return moved;
}

// The factor at hand serves again while iterations lead on, unless something changed its kind. A crowd's factor is dear: it serves
// nevertheless, once it has led on. @param last gradient of the last iteration, infinite before the first one
bool IslandProblem::keepsFactor(double last) const {
  return gradient_norm_ < CHORD_PROGRESS * last && (isFactorCurrent() || (isCrowd() && soft_ && factored_ && std::isfinite(last)));
}

// Iterates until the gradient is below `exactness` times the first one, or the tolerance; or, `patience` iterations having passed, one of
// them does not lead on. All velocities are known afterwards. Joints that stray are iterated from then on; if all were woken, a caller that
// gave a patience begins again.
int IslandProblem::newton(const NewtonSettings& settings, double exactness, int max_iterations, int patience) {
  double enough = settings.gradient_tolerance, last = INFINITY;
  for (int iterations = 0;; ++iterations) {
    if (!anchored_) {
      respondIdle();
      if (!anchor()) return iterations;
    }
    evaluateGradient();
    gradient_norm_ = gradientNorm(live_dofs_);
    if (iterations == 0) enough = std::max(enough, exactness * gradient_norm_);
    const bool over = iterations >= max_iterations || (iterations >= patience && gradient_norm_ > FIRST_PROGRESS * last);
    if (gradient_norm_ <= enough || over) {
      if (settle(enough) || over || (strayed_ && patience < max_iterations)) return iterations;
      last = INFINITY;
      continue;
    }
    const bool factored = keepsFactor(last) || factor();
    last = gradient_norm_;
    if (factored) findDirection();
    if (!factored || move(lineSearch()) < NO_STEP) {
      settle(enough);
      return factored ? iterations + 1 : iterations;
    }
  }
}

void IslandProblem::soften(double contact, double joint) {
  factored_ = responses_known_ = false;
  soft_ = contact > 1;
  forPatches([&](std::size_t index) {
    const ContactPatch& p = patches[index];
    for (int b = p.first_block, i = p.first; b < p.block_end; ++b, i += LANES)
      blem_sim::dynamics::soften(&contacts[i], p.end - i, contact, &contact_blocks_[b]);
  });
  joint_softness_ = joint;
  softenJoints();
  for (LoopTerm& loop : loops) loop.drive.softness = joint;
}

void IslandProblem::remember() {
  responses_known_ = false;
  slip_mixing_.remember(contact_blocks_.data(), contact_blocks_.data() + contact_blocks_.size());
  for (JointTerm& j : joints) j.remember(space_->velocity[j.dof]);
  setJoints();
  for (LoopTerm& loop : loops) loop.remember();
}

void IslandProblem::assess(NewtonReport* report) const {
  report->imbalance = imbalance();
  const ContactResidual contact = residual(contact_blocks_.data(), contact_blocks_.data() + contact_blocks_.size());
  report->contact_residual = contact.impulse;
  report->contact_creep = std::max(0.0, contact.speed - OF_FIRST_SPEED * first_speed_);
  report->joint_creep = creep(joint_blocks_.data(), joint_blocks_.data() + joint_blocks_.size());
  for (const LoopTerm& loop : loops) report->joint_creep = std::max(report->joint_creep, loop.creep());
}

// The impulse of a fold is the gradient on the mimic's own dof.
void IslandProblem::readMimics() {
  mimic_impulses.clear();
  if (mimics.empty()) return;
  evaluate();
  gradient();
  for (const MimicFold& m : mimics) mimic_impulses.push_back(space_->gradient[m.dof]);
}

NewtonReport IslandProblem::solve(const Forest& forest, const ForestMotion& motion, const NewtonSettings& settings, SolverSpace* space) {
  forest_ = &forest;
  motion_ = &motion;
  space_ = space;
  NewtonReport report;
  team_->with(settings.helpers, [&] { report = solveFirst(settings); });
  return report;
}

NewtonReport IslandProblem::solveFirst(const NewtonSettings& settings) {
  start();
  first_speed_ = fastest(contact_blocks_.data(), contact_blocks_.data() + contact_blocks_.size());
  NewtonReport report;
  if (isSolved(isHeap() ? HEAP_TOLERANCE * settings.gradient_tolerance : settings.gradient_tolerance)) {
    finish(settings, &report);
    return report;
  }
  keepFirst();
  if (isHeap()) {
    report = solveHeap(settings);
  } else {
    predict();
    report = iterate(settings);
    ++report.iterations;
  }
  if (faults(report) > 1) recover(&report);
  return report;
}

NewtonReport IslandProblem::solveAgain(const NewtonSettings& settings) {
  SolverSpace& s = *space_;
  for (const std::vector<int>* dofs : {&live_dofs_, &idle_dofs_})
    for (const int k : *dofs) s.kinetic[k] = s.mass_velocity[k] - s.free_momentum[k];
  keepFirst();
  NewtonReport report;
  team_->with(settings.helpers, [&] {
    report = isHeap() ? solveHeap(settings) : iterate(settings);
    if (faults(report) > 1) recover(&report);
  });
  return report;
}

NewtonReport IslandProblem::iterate(const NewtonSettings& settings) {
  NewtonReport report;
  const auto left = [&] { return settings.max_iterations - report.iterations; };
  // Most steps are like the one before: the hard problem is solved in a few iterations. If not, soft ones lead to it.
  // If idle joints stray, or are not known to do right, all are live, and everything is begun again.
  bool solved = false;
  for (;;) {
    strayed_ = false;
    const int iterations = newton(settings, 0, left(), FIRST_ITERATIONS);
    report.iterations += iterations;
    solved = gradient_norm_ <= settings.gradient_tolerance || iterations < FIRST_ITERATIONS;
    if (idle_dofs_.empty() ? !strayed_ : solved) break;
    for (const int k : idle_dofs_) wake(forest_->nodeOfDof(k));
    rewind();
    predict();
  }
  if (!solved) {
    for (int stage = 0; stage < SOFT_STAGES; ++stage) {
      soften(CONTACT_SOFTNESS[stage], JOINT_SOFTNESS[stage]);
      report.iterations += newton(settings, INEXACT, left());
      slip_mixing_.start(contact_blocks_.size() * LANES);
      remember();
    }
    soften(1, 1);
    report.iterations += newton(settings, INEXACT, left());
  }
  finish(settings, &report);
  return report;
}

void IslandProblem::finish(const NewtonSettings& settings, NewtonReport* report) {
  int last = settings.max_iterations;
  double least = INFINITY;
  for (int outer = 1, most = settings.max_outer; outer < most; ++outer) {
    assess(report);
    keepBalanced(*report, &least);
    const bool settled = !isHeap() || isCrowd() || isSettled();
    const bool lawful =
        settled && report->contact_residual <= settings.contact_tolerance && report->joint_creep <= settings.joint_tolerance;
    const bool exact = gradient_norm_ <= settings.gradient_tolerance;
    const int left = settings.max_iterations - report->iterations;
    if ((lawful && exact) || left <= 0) break;
    if (outer + 1 == most && last > 0 && left >= ENOUGH_TO_END && report->contact_creep > CREEPS) ++most;
    // The last step is led on until momentum is balanced; it does not mix slips: mixing leads beyond those that were found.
    const bool is_last = outer + 1 == most;
    const bool mixes = outer > 1 && last <= EASY && left >= ENOUGH_LEFT && !is_last;
    if (!mixes) slip_mixing_.start(contact_blocks_.size() * LANES);
    if (!lawful) remember();
    last = newton(settings, lawful || is_last ? 0 : mixes ? INEXACT_MIXED : INEXACT, left);
    report->iterations += last;
  }
  assess(report);
  returnToBalanced(least, report);
  readMimics();
  readTerms();
}

}  // namespace blem_sim::dynamics
