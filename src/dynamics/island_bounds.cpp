// Bounds on the energy that contacts may add on purpose: by correcting depth, and where nothing solved the problem.
#include <algorithm>
#include <cmath>

#include "island_problem.h"

namespace blem_sim {
namespace {

constexpr double AT_TARGET = 4;         // times the energy of an island that moves as fast as its fastest target: what correcting may take
constexpr double OF_CORRECTION = 0.25;  // of a gain of energy: the least share of contacts that gained it by correcting depth

}  // namespace

double IslandProblem::mass() const {
  double mass = 0;
  for (const int tree : trees) mass += motion_->composite[forest_->trees()[tree].first_node].mass;
  return mass;
}

double IslandProblem::fastestTarget() const {
  double fastest = 0;
  for (const ContactTerm& c : contacts) fastest = std::max(fastest, c.target);
  return fastest;
}

// [J] Overwrites space->mass_direction.
double IslandProblem::kineticEnergy(const Eigen::VectorXd& velocity) {
  SolverSpace& s = *space_;
  double twice = 0;
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    multiply(*forest_, tree, motion_->mass, velocity, &s.mass_direction, &s.paths);
    twice += velocity.segment(t.first_dof, t.dofCount()).dot(s.mass_direction.segment(t.first_dof, t.dofCount()));
  }
  return 0.5 * twice;
}

// Where friction locks what they push, as in a groove, no force suffices contacts to correct depth: they only keep bodies from coming
// closer. @return whether there is one
bool IslandProblem::giveUpLocked() {
  bool any = false;
  for (ContactTerm& c : contacts) {
    if (!(c.target > 0) || c.compliance > 0 || c.normal.dot(c.impulse) < hard_impulse) continue;
    c.target = 0;
    any = true;
  }
  return any;
}

// Contacts that lead bodies apart, and loops that close, need the energy of bodies that move at their targets. Those that hardly have a
// lever, or leave bodies no other way, would add any amount. @return share of their targets that is to be reached
double IslandProblem::affordableShare(double speed) {
  const double fastest = std::max(speed, fastestTarget()), enough = AT_TARGET * 0.5 * mass() * fastest * fastest;
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
  const bool limited = giveUpLocked() || share < 1;
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
  const double most = kineticEnergy(s.direction) + 0.5 * mass() * fastest * fastest, moves = kineticEnergy(s.velocity);
  if (moves <= most) return;
  const double share = std::isfinite(moves) && std::isfinite(most) ? std::sqrt(most / moves) : 0;
  for (const int tree : trees) {
    for (int k = forest_->trees()[tree].first_dof; k < forest_->trees()[tree].dof_end; ++k) {
      s.velocity[k] = share > 0 ? share * s.velocity[k] : 0;
      s.mass_velocity[k] = share > 0 ? share * s.mass_velocity[k] : 0;
    }
  }
}

}  // namespace blem_sim
