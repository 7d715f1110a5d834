#include "island/tree_pace.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

// A tree is fast if velocity products change its velocities by more than a share of them in a step. A tree that nothing drives has an
// energy to keep, and one that tumbles momenta as well. Of a robot that stands, or is bolted down, motors and friction tell how much energy
// comes and goes.
constexpr double SLOW_ALONE = 1e-4, SLOW_AT_WORK = 1e-3;
constexpr double SLOW_BEND = 1e-3;    // [rad] of a hinge in a step: beyond, products that are none at its start may be there at its end
constexpr double SLOW_ASTRAY = 1e-7;  // [J] of the energy of a tree that nothing drives
constexpr double TUMBLING = 0.4;      // [rad/s] of a free root: a robot that sways on its feet turns less
constexpr double SMALL_TURN = 0.05;   // [rad] of a free root in a step: beyond, products of the step's start are not those of its end
// Trees that are tied are solved with their products. Beyond this the products would add energy without bound:
// they are left out, and the trees are braked.
constexpr double TOO_FAST = 0.1;
constexpr double AT_REST = 1e-30;  // [J] twice the energy of a tree whose velocities are rounding: so are its products

/** [J] Twice the kinetic energy. @param mass_velocity M times the velocity */
double twiceEnergy(const FreeStart& start, const Eigen::VectorXd& mass_velocity) {
  const ForestTree& t = start.forest.trees()[start.tree];
  double energy = 0;
  for (int k = t.first_dof; k < t.dof_end; ++k) energy += start.velocity[k] * mass_velocity[k];
  return energy;
}

// Change of the velocities of a tree by its velocity products in a step, over the velocities in the frame of its centre of mass; in the
// norm of the energy, each dof's inertia taken alone; the more, the further the root turns. `mass_velocity`: M times the velocity.
double turningOf(const FreeStart& start, const Eigen::VectorXd& mass_velocity) {
  const auto [forest, tree, dt, motion, velocity] = start;
  const ForestTree& t = forest.trees()[tree];
  double change = 0;
  for (int k = t.first_dof; k < t.dof_end; ++k) change += motion.products[k] * motion.products[k] / motion.mass[forest.diagonal(k)];
  if (!(change > 0)) return 0;
  const double energy = twiceEnergy(start, mass_velocity);
  if (!t.free) return dt * std::sqrt(change / std::max(energy, AT_REST));
  const double inner = energy - mass_velocity.segment<3>(t.first_dof + 3).squaredNorm() / motion.composite[t.first_node].mass;
  const double turn = dt * velocity.segment<3>(t.first_dof).norm();
  return dt * std::sqrt(change / std::max({inner, 1e-12 * energy, AT_REST})) * std::max(1.0, turn / SMALL_TURN);
}

/** [rad] Largest turn of a hinge in a step at these velocities, if the tree's mass matrix depends on it. */
double bend(const FreeStart& start) {
  const ForestTree& t = start.forest.trees()[start.tree];
  if (t.dofCount() < 2) return 0;
  double most = 0;
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& n = start.forest.nodes()[i];
    if (n.dofs == 1 && n.kind == JointKind::REVOLUTE) most = std::max(most, start.dt * std::abs(start.velocity[n.first_dof]));
  }
  return most;
}

/** @param energy [J] twice the tree's kinetic energy, a share of which goes astray that grows with the square of its bend */
bool isSlow(const FreeStart& start, const StepInput& input, double turning, double energy) {
  const double bent = bend(start);
  if (turning > SLOW_AT_WORK || bent > SLOW_BEND) return false;
  const bool exact = turning <= SLOW_ALONE, astray = bent * bent * energy > SLOW_ASTRAY;
  if (exact && !astray) return true;
  const ForestTree& t = start.forest.trees()[start.tree];
  const bool tumbles = !exact && t.free && start.velocity.segment<3>(t.first_dof).norm() > TUMBLING;
  return !tumbles && isDriven(start.forest, start.tree, input);
}

}  // namespace

bool isDriven(const Forest& forest, int tree, const StepInput& input) {
  const auto drives = [](const JointDrive& d) {
    const bool motor = d.givenEffort() != 0 || (d.max_effort > 0 && (d.stiffness > 0 || d.damping > 0));
    return motor || d.dry_friction > 0 || d.viscous_friction > 0;
  };
  const ForestTree& t = forest.trees()[tree];
  if (rootDriveOf(input, forest.nodes()[t.first_node].body) >= 0) return true;
  return std::any_of(forest.nodes().begin() + t.first_node, forest.nodes().begin() + t.node_end,
                     [&](const ForestNode& n) { return n.dofs == 1 && drives(input.drives[n.joint]); });
}

bool isTied(const Forest& forest, int tree) {
  const auto belongs = [&](int node) { return node >= 0 && forest.nodes()[node].tree == tree; };
  const auto closes = [&](const LoopClosure& l) { return belongs(l.child) || belongs(l.parent); };
  const auto leads_away = [&](const MimicRelation& m) { return belongs(m.node) != belongs(m.master); };
  return std::any_of(forest.loops().begin(), forest.loops().end(), closes) ||
         std::any_of(forest.mimics().begin(), forest.mimics().end(), leads_away);
}

bool hasMimics(const Forest& forest, int tree) {
  return std::any_of(forest.mimics().begin(), forest.mimics().end(),
                     [&](const MimicRelation& m) { return forest.nodes()[m.node].tree == tree; });
}

Pace paceOf(const FreeStart& start, const StepInput& input, const Eigen::VectorXd& mass_velocity) {
  const double turning = turningOf(start, mass_velocity);
  if (isSlow(start, input, turning, twiceEnergy(start, mass_velocity))) return Pace::SLOW;
  if (!isTied(start.forest, start.tree)) return Pace::FAST;
  return turning > TOO_FAST ? Pace::TOO_FAST : Pace::SLOW;
}

}  // namespace blem_sim::dynamics
