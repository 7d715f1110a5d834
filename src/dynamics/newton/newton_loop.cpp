#include "newton/newton_loop.h"

#include <algorithm>
#include <cmath>

#include "newton/line_search.h"
#include "problem/island_velocity.h"

namespace blem_sim::dynamics {
namespace {

constexpr double FIRST_PROGRESS = 0.1;  // an iteration that leads somewhere reduces the gradient to this
constexpr double CHORD_PROGRESS = 0.1;  // a factor that is not made anew must have reduced the gradient to this
constexpr double NO_STEP = 1e-16;       // [rad/s or m/s] largest change of a velocity that is none

bool isOver(const RunLimits& limits, const NewtonRun& run, double last) {
  return run.iterations >= limits.most || (run.iterations >= limits.patience && run.gradient > FIRST_PROGRESS * last);
}

}  // namespace

void NewtonLoop::start(const IslandAtHand& island) {
  island_ = &island;
  iterate_.start(island);
  hessian_.start(island, iterate_);
  hessian_.forget();
  idle_.start(island, &iterate_);
  idle_.forget();
}

void NewtonLoop::begin() {
  iterate_.begin();
  hessian_.forget();
  idle_.forget();
}

void NewtonLoop::beginAllLive() {
  iterate_.live().wakeAll();
  returnToFirst(*island_);
  begin();
}

void NewtonLoop::soften(double contact, double joint) {
  hessian_.forgetFactor();
  iterate_.reactions().soften(contact, joint);
}

void NewtonLoop::rememberUnmixed() {
  iterate_.reactions().forgetSlips();
  iterate_.reactions().remember();
}

// Idle dofs first: they cost least.
double NewtonLoop::firstGradient(double tolerance) {
  const double idle = iterate_.evaluateIdleGradient();
  return idle > tolerance ? idle : std::max(idle, iterate_.evaluateGradient());
}

void NewtonLoop::predict() {
  iterate_.reactions().expect();
  if (!follow()) return;
  iterate_.evaluateGradient();
  if (!hessian_.factor()) return;
  hessian_.findDirection();
  iterate_.setDirection();
  iterate_.move(1);
}

NewtonRun NewtonLoop::run(const RunLimits& limits) {
  NewtonRun run;
  double enough = limits.tolerance, last = INFINITY;
  for (;; ++run.iterations) {
    if (!idle_.areFollowing()) {
      iterate_.reactions().respondIdle();
      if (!follow()) return {run.iterations, INFINITY, run.strayed};
    }
    run.gradient = iterate_.evaluateGradient();
    if (run.iterations == 0) enough = std::max(enough, limits.exactness * run.gradient);
    const bool over = isOver(limits, run, last);
    if (run.gradient <= enough || over) {
      const IdleBranches::Outcome outcome = settle(enough, &run.gradient);
      run.strayed |= outcome == IdleBranches::Outcome::STRAYED;
      const bool begins_again = run.strayed && limits.patience < limits.most;
      if (outcome == IdleBranches::Outcome::FOLLOWED || over || begins_again) return run;
      last = INFINITY;
      continue;
    }
    const bool factored = keepsFactor(run.gradient, last) || hessian_.factor();
    last = run.gradient;
    if (factored && step()) continue;
    run.strayed |= settle(enough, &run.gradient) == IdleBranches::Outcome::STRAYED;
    if (factored) ++run.iterations;
    return run;
  }
}

// Moves to the least along the direction. @return whether velocities have changed
bool NewtonLoop::step() {
  hessian_.findDirection();
  return !(iterate_.move(searchLine(*island_, &iterate_)) < NO_STEP);
}

// Idle branches follow from the velocities at hand. @return false if their matrix is not positive definite
bool NewtonLoop::follow() {
  if (!idle_.isBaseCurrent()) {
    hessian_.forgetFactor();
    if (!idle_.eliminateIdle()) return false;
  }
  idle_.follow();
  return true;
}

// Ends following; joints that stray are iterated from now on. @param gradient the larger of itself and what was missed, out
IdleBranches::Outcome NewtonLoop::settle(double enough, double* gradient) {
  double missed = 0;
  const IdleBranches::Outcome outcome = idle_.settle(enough, &missed);
  *gradient = std::max(*gradient, missed);
  if (outcome == IdleBranches::Outcome::FOLLOWED) return outcome;
  iterate_.takeWoken();
  hessian_.forget();
  return outcome;
}

// The factor at hand serves again while iterations lead on, unless something changed its kind. A crowd's factor is dear: it serves
// nevertheless, once it has led on. @param last gradient of the last iteration, infinite before the first one
bool NewtonLoop::keepsFactor(double gradient, double last) const {
  if (!(gradient < CHORD_PROGRESS * last)) return false;
  const bool is_dear = island_->model.isCrowd() && iterate_.reactions().contacts().isSoft();
  return hessian_.isCurrent() || (is_dear && hessian_.isFactored() && std::isfinite(last));
}

void NewtonLoop::finish(NewtonReport* report) {
  assess(*island_, iterate_, report);
  iterate_.read();
}

double NewtonLoop::adopt() {
  multiplyMass(*island_, island_->space->velocity, &island_->space->mass_velocity);
  setKinetic(*island_);
  begin();
  iterate_.reactions().adoptImpulses();
  const double live = iterate_.evaluateGradient();
  return std::max(live, iterate_.evaluateIdleGradient());
}

}  // namespace blem_sim::dynamics
