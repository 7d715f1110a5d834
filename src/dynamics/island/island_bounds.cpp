// Bounds on contacts that correct depth: on their pushes and the energy they add; and on velocities where nothing solved the problem.
#include <algorithm>
#include <cmath>

#include "island/island_problem.h"

namespace blem_sim::dynamics {
namespace {

constexpr double AT_TARGET = 4;         // times the energy of an island as fast as its fastest target: most that correcting depth may take
constexpr double HARD = 10;             // times the fastest correction of depth: a push that makes the whole island so fast is hard
constexpr double OF_CORRECTION = 0.25;  // of a gain of energy: the least share of contacts that gained it by correcting depth

}  // namespace

double IslandProblem::fastestTarget() const {
  double fastest = 0;
  for (const ContactTerm& c : contacts) fastest = std::max(fastest, c.target);
  return fastest;
}

// Kinetic energy [J] at a velocity. Overwrites space->mass_direction.
double IslandProblem::kineticEnergy(const Eigen::VectorXd& velocity) {
  SolverSpace& s = *space_;
  for (const int tree : trees) multiply(*forest_, tree, motion_->mass, velocity, &s.mass_direction, &s.paths);
  return 0.5 * dotProduct(*forest_, trees, velocity, s.mass_direction);
}

double IslandProblem::hardPush(double speed) const { return HARD * speed * mass; }

// Contacts of a body that friction locks, as in a groove, correct depth by no force, however large: they only keep bodies from coming
// closer. @return whether there is one
bool IslandProblem::giveUpLocked(double speed) {
  const double hard = hardPush(speed);
  bool any = false;
  for (ContactTerm& c : contacts) {
    if (!(c.target > 0) || c.compliance > 0 || c.normal.dot(c.impulse) < hard) continue;
    c.target = 0;
    any = true;
  }
  return any;
}

// Contacts that lead bodies apart, and loops that close, need the energy of bodies that move at their targets. Contacts that hardly have a
// lever, or leave bodies no other way, would add any amount. @return share of the targets that is to be reached
double IslandProblem::affordableShare(double speed) {
  const double fastest = std::max(speed, fastestTarget()), enough = AT_TARGET * 0.5 * mass * fastest * fastest;
  double work = 0;
  for (const ContactTerm& c : contacts) work += std::max(0.0, c.normal.dot(c.impulse)) * std::max(0.0, c.target);
  for (const LoopTerm& loop : loops) work += loop.impulses().cwiseProduct(loop.target).cwiseMax(0.0).sum();
  if (!(work > enough)) return 1;
  const double before = kineticEnergy(motion_->velocity), after = kineticEnergy(space_->velocity);
  const double most = std::sqrt(before) + std::sqrt(enough), is = std::sqrt(after);
  return is > most && work > OF_CORRECTION * (after - before) ? std::sqrt(enough) / is : 1;
}

bool IslandProblem::limitCorrections(double speed) {
  const double share = affordableShare(speed);
  const bool limited = giveUpLocked(speed) || share < 1;
  if (!limited) return false;
  for (ContactTerm& c : contacts) c.target = std::min(c.target, share * c.target);
  for (LoopTerm& loop : loops) loop.target *= share;
  begin();
  return true;
}

// The last resort where nothing found a solution: contacts that contradict each other may ask for any speed. All velocities shrink alike
// until the island moves with no more energy than without contacts, or than it needs to move at the fastest target of its contacts.
void IslandProblem::boundEnergy() {
  SolverSpace& s = *space_;
  sweeps_.freeVelocity(&s.direction);
  const double fastest = fastestTarget();
  const double most = kineticEnergy(s.direction) + 0.5 * mass * fastest * fastest, moves = kineticEnergy(s.velocity);
  if (moves <= most) return;
  const double share = std::isfinite(moves) && std::isfinite(most) ? std::sqrt(most / moves) : 0;
  for (const int tree : trees) {
    for (int k = forest_->trees()[tree].first_dof; k < forest_->trees()[tree].dof_end; ++k) {
      s.velocity[k] = share > 0 ? share * s.velocity[k] : 0;
      s.mass_velocity[k] = share > 0 ? share * s.mass_velocity[k] : 0;
    }
  }
}

}  // namespace blem_sim::dynamics
