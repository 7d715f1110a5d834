#include "sweeps/swept_island.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr int MOTOR_ROUNDS = 4;                              // searches for the motors that are at their bounds
constexpr double FREE_ENERGY = 1e-9, GAIN_OF_MOTION = 1e-6;  // [J], and of the work that contacts exchange: most that sweeps may gain

}  // namespace

void SweptIsland::start(const IslandAtHand& island, NewtonLoop* newton) {
  island_ = &island;
  newton_ = newton;
}

bool SweptIsland::load(SweepStart start) {
  SolverSpace& s = *island_->space;
  forDofs(*island_, [&s](int k) { s.velocity[k] = s.first_velocity[k]; });
  return sweeps_.load(*island_, start, &s.velocity);
}

bool SweptIsland::sweepWithMotors(SweepStart start, double enough, SweepReport* report) {
  Eigen::VectorXd* velocity = &island_->space->velocity;
  if (!load(start)) return false;
  *report = sweep(MOST_SWEEPS, enough);
  for (int round = 1; round < MOTOR_ROUNDS && !sweeps_.motorsAgree(*velocity); ++round) {
    sweeps_.read(*velocity, island_->terms());
    for (ContactTerm& c : island_->terms()->contacts) c.previous = c.impulse;
    if (!sweeps_.loadAgain(velocity)) return false;
    report->sweeps += sweep(MOST_SWEEPS, enough).sweeps;
  }
  return true;
}

double SweptIsland::adoptImpulses() {
  sweeps_.read(island_->space->velocity, island_->terms());
  return newton_->adopt();
}

// Kinetic energy that impulses of contacts, joint friction, limits and loops add to that of free motion, correction of errors left out. All
// exact impulses together never add any; those of some may, where others take more. Precondition: adoptImpulses.
ImpulseWork SweptIsland::impulseWork() {
  ImpulseWork work;
  const Eigen::VectorXd& velocity = island_->space->velocity;
  Eigen::VectorXd* free_velocity = &island_->space->direction;
  sweeps_.freeVelocity(free_velocity);
  newton_->setSteps(*free_velocity);
  const IslandContacts& contacts = newton_->iterate().reactions().contacts();
  contacts.forEach([&](int contact, std::size_t block, int lane) {
    const ContactTerm& term = island_->terms()->contacts[contact];
    const ContactBlock& b = contacts.blocks()[block];
    for (int axis = 0; axis < 3; ++axis) {
      const double g = b.impulse[axis][lane], correction = g * std::max(0.0, term.target) * term.normal[axis];
      work.add(g, b.step[axis][lane] + term.bend[axis], b.velocity[axis][lane], correction);
    }
  });
  sweeps_.addJointWork(*free_velocity, velocity, &work);
  return work;
}

double SweptIsland::adopt() {
  const double gradient = adoptImpulses();
  const ImpulseWork work = impulseWork();
  const double bound = FREE_ENERGY + GAIN_OF_MOTION * work.exchanged;
  if (work.gained <= bound) return gradient;
  // Impulses a times as large gain a (first + a second): the factor a makes this gain nothing.
  const double second = 0.5 * work.change, first = work.gained - second;
  sweeps_.scale(second > 0 ? std::clamp(-first / second, 0.0, 1.0) : 0, &island_->space->velocity);
  return adoptImpulses();
}

double SweptIsland::adoptAgain() {
  sweeps_.scale(1, &island_->space->velocity);
  return adopt();
}

}  // namespace blem_sim::dynamics
