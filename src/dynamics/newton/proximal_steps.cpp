#include "newton/proximal_steps.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

// Shares of a proximal step's first gradient: the next step changes the problem again, so this one need not be solved to the last digit.
constexpr double INEXACT = 0.02, INEXACT_MIXED = 1e-4;  // mixed slips begin far away: a miss that is to lead on must not be the rest
// Proximal weights of the first steps against the last one's: soft contacts and soft joint friction find in few iterations which contacts
// and joints stick.
constexpr int SOFT_STAGES = 2;
constexpr double CONTACT_SOFTNESS[SOFT_STAGES] = {1000, 30};
constexpr double JOINT_SOFTNESS[SOFT_STAGES] = {10, 3};
constexpr double CROWD_SOFTNESS = 10;       // of the last one's: stiff contacts of a crowd change their kinds in many dear iterations
constexpr int MORE_ITERATIONS = 6;          // first ones of a still crowd: soft contacts would cost three times as many
constexpr int EASY = 10, ENOUGH_LEFT = 20;  // iterations of a proximal step whose slips are mixed, and of those that are left then
// Contacts of a light body between heavy ones still creep so fast after the proximal steps that suffice elsewhere: they
// get more, as long as a step takes an iteration.
constexpr double CREEPS = 1e-3;    // [m/s]
constexpr int ENOUGH_TO_END = 30;  // iterations that are left for a last step
// Largest change of an impulse, of the largest one: by a heap's last proximal step, and since the last time step where it makes one alone.
constexpr double SETTLED = 1e-4, NEARLY_SETTLED = 1e-2;

void count(const NewtonRun& run, NewtonReport* report) {
  report->iterations += run.iterations;
  report->gradient = run.gradient;
}

RunLimits limitsOf(const NewtonSettings& settings, double exactness, const NewtonReport& report) {
  RunLimits limits;
  limits.tolerance = settings.gradient_tolerance;
  limits.exactness = exactness;
  limits.most = settings.max_iterations - report.iterations;
  return limits;
}

}  // namespace

void ProximalSteps::start(const IslandAtHand& island, NewtonLoop* newton) {
  island_ = &island;
  newton_ = newton;
}

NewtonReport ProximalSteps::solve(const NewtonSettings& settings) {
  NewtonReport report;
  if (!solveHard(settings, FIRST_ITERATIONS, &report)) solveSoft(settings, &report);
  finish(settings, &report);
  return report;
}

NewtonReport ProximalSteps::solvePredicted(const NewtonSettings& settings) {
  newton_->predict();
  NewtonReport report = solve(settings);
  ++report.iterations;
  return report;
}

NewtonReport ProximalSteps::solveNext(const NewtonSettings& settings) {
  newton_->predict();
  NewtonReport report;
  const bool solved = solveHard(settings, MORE_ITERATIONS, &report);
  if (!solved) solveSoft(settings, &report);
  if (solved && newton_->iterate().reactions().contacts().areSettled(NEARLY_SETTLED))
    newton_->finish(&report);
  else
    finish(settings, &report);
  ++report.iterations;
  return report;
}

NewtonReport ProximalSteps::solveSoftened(const NewtonSettings& settings) {
  NewtonReport report;
  runSoftened(CROWD_SOFTNESS, 1, settings, &report);
  finish(settings, &report);
  return report;
}

// Most steps are like the one before: the hard problem is solved in a few iterations. If idle joints stray, or are not known to do right,
// all are live, and everything is begun again.
bool ProximalSteps::solveHard(const NewtonSettings& settings, int patience, NewtonReport* report) {
  for (;;) {
    RunLimits limits = limitsOf(settings, 0, *report);
    limits.patience = patience;
    const NewtonRun run = newton_->run(limits);
    count(run, report);
    const bool solved = run.gradient <= settings.gradient_tolerance || run.iterations < patience;
    const bool all_live = newton_->iterate().live().idleDofs().empty();
    if (all_live ? !run.strayed : solved) return solved;
    newton_->beginAllLive();
    newton_->predict();
  }
}

void ProximalSteps::solveSoft(const NewtonSettings& settings, NewtonReport* report) {
  for (int stage = 0; stage < SOFT_STAGES; ++stage) {
    runSoftened(CONTACT_SOFTNESS[stage], JOINT_SOFTNESS[stage], settings, report);
    newton_->rememberUnmixed();
  }
  runSoftened(island_->model.isHeap() && island_->model.isCrowd() ? CROWD_SOFTNESS : 1, 1, settings, report);
}

void ProximalSteps::runSoftened(double contact, double joint, const NewtonSettings& settings, NewtonReport* report) {
  newton_->soften(contact, joint);
  count(newton_->run(limitsOf(settings, INEXACT, *report)), report);
}

// Impulses of a heap must be settled, too. Residuals alone do not tell: each contact of a tower that leans misses Coulomb's law by little,
// but together they let it sway.
bool ProximalSteps::isLawful(const NewtonSettings& settings, const NewtonReport& report) const {
  if (island_->model.isHeap() && !newton_->iterate().reactions().contacts().areSettled(SETTLED)) return false;
  return report.contact_residual <= settings.contact_tolerance && report.joint_creep <= settings.joint_tolerance;
}

void ProximalSteps::finish(const NewtonSettings& settings, NewtonReport* report) {
  int last = settings.max_iterations;
  double least = INFINITY;
  for (int step = 1, steps = settings.max_outer; step < steps; ++step) {
    assess(*island_, newton_->iterate(), report);
    keepBalanced(*report, &least);
    const bool lawful = isLawful(settings, *report);
    const int left = settings.max_iterations - report->iterations;
    if ((lawful && report->gradient <= settings.gradient_tolerance) || left <= 0) break;
    if (step + 1 == steps && last > 0 && left >= ENOUGH_TO_END && report->contact_creep > CREEPS) ++steps;
    // The last step is led on until momentum is balanced, and so is a heap's each from half of its iterations on: an unbalanced one sways.
    // The last one does not mix slips: mixing leads beyond those that were found.
    const bool is_last = step + 1 == steps, balances = is_last || (island_->model.isHeap() && 2 * left <= settings.max_iterations);
    const bool mixes = step > 1 && last <= EASY && left >= ENOUGH_LEFT && !is_last;
    if (!mixes) newton_->forgetSlips();
    if (!lawful) newton_->remember();
    const NewtonRun run = newton_->run(limitsOf(settings, lawful || balances ? 0 : mixes ? INEXACT_MIXED : INEXACT, *report));
    count(run, report);
    last = run.iterations;
  }
  assess(*island_, newton_->iterate(), report);
  returnToBalanced(least, report);
  newton_->read();
}

// Keeps the best proximal step of a heap that balanced momentum, since the budget may end at any step.
void ProximalSteps::keepBalanced(const NewtonReport& report, double* least) {
  if (!island_->model.isHeap() || !(report.imbalance <= BALANCED) || !(report.contact_residual < *least)) return;
  *least = report.contact_residual;
  newton_->iterate().reactions().contacts().read();
  balanced_.take(*island_);
}

void ProximalSteps::returnToBalanced(double least, NewtonReport* report) {
  if (report->imbalance <= BALANCED || !std::isfinite(least)) return;
  balanced_.put(*island_);
  report->gradient = newton_->adopt();
  assess(*island_, newton_->iterate(), report);
}

}  // namespace blem_sim::dynamics
