#include "island/island_motion.h"

#include <algorithm>
#include <cmath>

#include "island/tree_pace.h"
#include "problem/island_at_hand.h"
#include "problem/joint_leads.h"

namespace blem_sim::dynamics {
namespace {

// Share of the velocity products that a row's free momentum takes. A free root carries its momentum from middle to middle of its steps,
// half a step beside the poses where the mass matrix holds.
double productsShare(const ForestTree& tree, int dof) { return tree.free && dof < tree.first_dof + 6 ? 0.5 : 1; }

constexpr double ONE_MOTION = 1e-6;  // of the fastest body's velocities: welded bodies that differ by less move as one, but for rounding

bool isFast(const ForestMotion& motion, int tree) { return motion.pace[tree] == Pace::FAST; }

/** Inertia and debt of a dof and of those that mimic relations move with it, seen at that dof. */
struct MovedAlong {
  double inertia = 0;  ///< [kg m^2 or kg] at most
  double owed = 0;     ///< [N m s or N s] by their last way
};

// Inertias of joints that move together are at most the square of the sum of their roots.
MovedAlong movedAlong(const Forest& forest, const ForestMotion& motion, int dof) {
  const auto dofOf = [&](int node) { return forest.nodes()[node].first_dof; };
  int master = dof;
  double multiplier = 1;
  for (const MimicRelation& m : forest.mimics()) {
    if (dofOf(m.node) != dof) continue;
    master = dofOf(m.master);
    multiplier = m.multiplier;
  }
  const auto root = [&](int k) { return std::sqrt(motion.mass[forest.diagonal(k)]); };
  double inertia_root = root(master), owed = motion.owed[master];
  for (const MimicRelation& m : forest.mimics()) {
    if (dofOf(m.master) != master) continue;
    inertia_root += std::abs(m.multiplier) * root(dofOf(m.node));
    owed += m.multiplier * motion.owed[dofOf(m.node)];
  }
  return {inertia_root * inertia_root / (multiplier * multiplier), owed / multiplier};
}

// Lasting push on a limit: the impulse that it bore in the solve, without those that stopped the joint or paid for the last way. A limit
// that gave way by more would push the joint off in the next step.
// @param side 1: the lower limit, -1: the upper one @param change [rad/s or m/s] of the joint's velocity
double pressOn(double side, double impulse, double change, const MovedAlong& along) {
  return impulse > 0 ? std::max(0.0, impulse - side * along.owed - along.inertia * std::max(0.0, side * change)) : 0;
}

// Joints that answer stiffly keep their velocity on the way, as far as motor, friction and limits reach.
void setHold(const JointTerm& joint, double velocity, const Forest& forest, const ForestMotion& motion, FreeMotion* way) {
  const int k = joint.dof;
  const double reach = (joint.motor_gain > 0 ? joint.motor_bound : 0) + joint.dry_bound;
  const double lower = joint.lowerImpulse(velocity), upper = joint.upperImpulse(velocity), change = velocity - motion.velocity[k];
  const MovedAlong along = lower > 0 || upper > 0 ? movedAlong(forest, motion, k) : MovedAlong();
  way->held()[k] = keepsVelocity(joint, velocity, motion.mass[forest.diagonal(k)]);
  way->most[k] = lower > 0 ? INFINITY : reach + pressOn(-1, upper, change, along);
  way->least[k] = upper > 0 ? -INFINITY : -reach - pressOn(1, lower, change, along);
}

// A share of a bound that may be infinite.
double times(double multiplier, double bound) { return multiplier == 0 ? 0 : multiplier * bound; }

// Joints that follow the same one keep their velocities on the way, and so does that one, or none of them: as far as all of them reach.
void holdMimics(const Forest& forest, int tree, FreeMotion* way) {
  forFollowers(forest, tree, [&](int dof, int master, double) { way->held()[master] |= way->held()[dof]; });
  forFollowers(forest, tree, [&](int dof, int master, double multiplier) {
    way->held()[dof] = way->held()[master];
    const double one = times(multiplier, way->least[dof]), other = times(multiplier, way->most[dof]);
    way->least[master] += std::min(one, other);
    way->most[master] += std::max(one, other);
    way->least[dof] = -INFINITY;
    way->most[dof] = INFINITY;
  });
}

void turn(double dt, const Vector3& spin, Matrix3* R) {
  const double angle = dt * spin.norm();
  if (!(angle > 0)) return;
  const Quaternion step(Eigen::AngleAxisd(angle, spin.normalized()));
  *R = (step * Quaternion(*R)).normalized().toRotationMatrix();
}

// Moves joints by their next velocity, a free root by its centre of mass.
void integrate(const Forest& forest, int tree, double dt, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i)
    if (forest.nodes()[i].dofs == 1) motion->position[i] += dt * motion->next_velocity[forest.nodes()[i].first_dof];
  for (int k = t.first_dof; k < t.dof_end; ++k) {
    motion->change[k] = motion->next_velocity[k] - motion->velocity[k];
    motion->velocity[k] = motion->next_velocity[k];
  }
  if (!t.free) return;
  const Vector3& com_B = forest.nodes()[t.first_node].inertial.com;
  const Vector3 com = motion->reference[tree] + dt * motion->velocity.segment<3>(t.first_dof + 3);
  turn(dt, motion->velocity.segment<3>(t.first_dof), &motion->rotation[t.first_node]);
  motion->origin[t.first_node] = com - motion->rotation[t.first_node] * com_B;
}

// Moves a flying tree so that its centre of mass is where its momentum leads: joints that turn while the root moves would lead it astray.
// All of it is placed anew from its root, as a restored one is.
void followMomentum(const Forest& forest, int tree, const Vector3& target, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  motion->origin[t.first_node] += target - (motion->reference[tree] + motion->tree_com[tree]);
  placeBodies(forest, tree, motion);
  computeInertias(forest, tree, motion);
}

// The velocities of the solve, taken on to the end of the step without velocity products, may have more energy there. The island loses it:
// all velocities shrink alike, so that mimic joints and loops keep their relations. Momenta are those of the velocities from then on: the
// next step would find others by energy that nobody knows of.
void brake(const Forest& forest, const std::vector<int>& trees, ForestMotion* motion, SolverSpace* space) {
  const double solved = dotProduct(forest, trees, space->velocity, space->mass_velocity);
  for (const int tree : trees) multiply({forest, tree, motion->mass}, motion->velocity, &space->mass_velocity, &space->paths);
  const double there = dotProduct(forest, trees, motion->velocity, space->mass_velocity);
  const double share = there > solved ? std::sqrt(std::max(0.0, solved) / there) : 1;  // below nothing by rounding
  for (const int tree : trees) {
    const ForestTree& t = forest.trees()[tree];
    motion->velocity.segment(t.first_dof, t.dofCount()) *= share;
    takeMomentum(forest, tree, motion, space);
  }
}

// Drift takes on what velocity products do to a fast tree on its way: contacts follow its path (bendAt in make_terms.cpp).
void addFreeAcceleration(const Forest& forest, int tree, ForestMotion* motion, SolverSpace* space) {
  const ForestTree& t = forest.trees()[tree];
  space->direction.segment(t.first_dof, t.dofCount()) = -motion->products.segment(t.first_dof, t.dofCount());
  factorTree({forest, tree, motion->mass}, &space->hessian);
  solveTree(forest, tree, space->hessian, &space->direction, &space->paths);
  computeTwists(forest, tree, *motion, space->direction, &space->twist);
  for (int i = t.first_node; i < t.node_end; ++i) motion->drift[i] += space->twist[i];
}

// The tree is followed on its way from now on, or braked, without the products that its free momentum took.
void setPace(Pace pace, const TreeAhead& ahead, ForestMotion* motion, SolverSpace* space) {
  const ForestTree& t = ahead.forest.trees()[ahead.tree];
  motion->pace[ahead.tree] = pace;
  for (int k = t.first_dof; k < t.dof_end; ++k) {
    space->free_momentum[k] += ahead.input.dt * productsShare(t, k) * motion->products[k];
    motion->products[k] = 0;
  }
}

}  // namespace

void joinVelocities(const Forest& forest, const Scene& scene, int tree, ForestMotion* motion, SolverSpace* space) {
  const ForestTree& t = forest.trees()[tree];
  double apart = 0, fastest = 0;
  for (int i = t.first_node; i < t.node_end; ++i) {
    const int body = forest.nodes()[i].body;
    const Vector3 velocity = scene.velocity(body), spin = scene.spin(body);
    const Vector6 own = spatial(spin, velocity - spin.cross(motion->com[i])), difference = own - motion->twist[i];
    motion->node_force[i] = motion->inertia[i].times(difference);
    if (forest.nodes()[i].dofs == 0) apart = std::max({apart, angular(difference).norm(), velocityAt(difference, motion->com[i]).norm()});
    fastest = std::max({fastest, spin.norm(), velocity.norm()});
  }
  if (apart <= ONE_MOTION * fastest) return;
  space->direction.segment(t.first_dof, t.dofCount()).setZero();
  WrenchProjection{forest, *motion, 1, &motion->node_force, &space->direction}.addTree(tree);
  factorTree({forest, tree, motion->mass}, &space->hessian);
  solveTree(forest, tree, space->hessian, &space->direction, &space->paths);
  motion->velocity.segment(t.first_dof, t.dofCount()) += space->direction.segment(t.first_dof, t.dofCount());
  computeTwists(forest, tree, *motion, motion->velocity, &motion->twist);
}

void takeMomentum(const Forest& forest, int tree, ForestMotion* motion, SolverSpace* space) {
  const ForestTree& t = forest.trees()[tree];
  if (!t.free) return;
  multiply({forest, tree, motion->mass}, motion->velocity, &space->mass_velocity, &space->paths);
  motion->momentum[tree] = space->mass_velocity.segment<6>(t.first_dof);
}

void setFreeMomentum(const TreeAhead& ahead, ForestMotion* motion, SolverSpace* space) {
  const auto& [forest, scene, input, tree, touched] = ahead;
  const ForestTree& t = forest.trees()[tree];
  const int first = t.first_dof, count = t.dofCount();
  computeApplied(forest, scene, tree, motion);
  space->direction.segment(first, count) = motion->velocity.segment(first, count) + 0.5 * motion->change.segment(first, count);
  computeProducts(forest, tree, space->direction, motion);
  multiply({forest, tree, motion->mass}, motion->velocity, &space->mass_velocity, &space->paths);
  const FreeStart start{forest, tree, input.dt, *motion, motion->velocity};
  motion->pace[tree] = paceOf(start, input, space->mass_velocity);
  if (isFast(*motion, tree) && touched && !isDriven(forest, tree, input) && !hasMimics(forest, tree))
    addFreeAcceleration(forest, tree, motion, space);
  if (motion->pace[tree] != Pace::SLOW) motion->products.segment(first, count).setZero();
  space->free_momentum.segment(first, count) = space->mass_velocity.segment(first, count);
  if (t.free) space->free_momentum.segment<6>(first) = motion->momentum[tree];
  for (int k = first; k < t.dof_end; ++k) {
    space->free_momentum[k] += input.dt * (motion->applied[k] - productsShare(t, k) * motion->products[k]);
    space->free_momentum[k] -= motion->owed[k];
    space->velocity[k] = motion->velocity[k];
  }
}

void followAlone(const TreeAhead& ahead, ForestMotion* motion, SolverSpace* space) {
  const auto& [forest, scene, input, tree, touched] = ahead;
  const bool follows = motion->pace[tree] == Pace::SLOW && !isDriven(forest, tree, input) && !isTied(forest, tree);
  if (follows) setPace(Pace::FAST, ahead, motion, space);
}

void addEfforts(const StepInput& input, const IslandTerms& terms, SolverSpace* space) {
  for (const JointTerm& j : terms.joints)
    if (j.joint >= 0) space->free_momentum[j.dof] += input.dt * input.drives[j.joint].givenEffort() + j.viscousLead();
}

double correctProducts(const TreeAhead& ahead, ForestMotion* motion, SolverSpace* space) {
  const auto& [forest, scene, input, tree, touched] = ahead;
  if (motion->pace[tree] != Pace::SLOW) return 0;
  const ForestTree& t = forest.trees()[tree];
  const int first = t.first_dof, count = t.dofCount();
  space->gradient.segment(first, count) = motion->products.segment(first, count);
  space->direction.segment(first, count) = 0.5 * (motion->velocity.segment(first, count) + space->velocity.segment(first, count));
  computeProducts(forest, tree, space->direction, motion);
  const Pace pace = paceOf({forest, tree, input.dt, *motion, space->velocity}, input, space->mass_velocity);
  if (pace != Pace::SLOW) {
    motion->products.segment(first, count) = space->gradient.segment(first, count);
    setPace(pace, ahead, motion, space);
    return INFINITY;
  }
  double worst = 0;
  for (int k = first; k < t.dof_end; ++k) {
    const double change = input.dt * productsShare(t, k) * (motion->products[k] - space->gradient[k]);
    space->free_momentum[k] -= change;
    worst = std::max(worst, std::abs(change) * space->scale[k]);
  }
  return worst;
}

bool followFast(const SolvedIsland& island, const ForestMotion& motion, const SolverSpace& space, FreeMotion* way) {
  const std::vector<int>& trees = island.model.trees;
  const auto turns = [&](int tree) { return motion.pace[tree] != Pace::SLOW; };
  if (std::none_of(trees.begin(), trees.end(), turns)) return true;
  bool followed = true;
  for (const JointTerm& j : island.found.joints)
    if (j.joint >= 0) setHold(j, space.velocity[j.dof], island.forest, motion, way);
  for (const int tree : trees) {
    followed &= motion.pace[tree] != Pace::TOO_FAST;
    if (!isFast(motion, tree)) continue;
    const FreeStart start{island.forest, tree, island.dt, motion, space.velocity};
    holdMimics(island.forest, tree, way);
    followed &= way->follow(start, space.mass_velocity).followed;
  }
  return followed;
}

void advanceIsland(const SolvedIsland& island, const FreeMotion& way, ForestMotion* motion, SolverSpace* space) {
  const Forest& forest = island.forest;
  const double dt = island.dt;
  const bool flies = island.found.contacts.empty() && island.found.loops.empty();
  forTrees(island.model, island.team, [&](int tree) {
    const ForestTree& t = forest.trees()[tree];
    if (t.free) motion->momentum[tree] = space->mass_velocity.segment<6>(t.first_dof) + 0.5 * dt * motion->products.segment<6>(t.first_dof);
    if (isFast(*motion, tree)) {
      motion->change.segment(t.first_dof, t.dofCount()) = -motion->velocity.segment(t.first_dof, t.dofCount());
      way.takeEnd(forest, tree, motion);
      motion->change.segment(t.first_dof, t.dofCount()) += motion->velocity.segment(t.first_dof, t.dofCount());
    } else {
      motion->owed.segment(t.first_dof, t.dofCount()).setZero();
      integrate(forest, tree, dt, motion);
    }
  });
  for (const MimicRelation& m : forest.mimics())
    if (std::binary_search(island.model.trees.begin(), island.model.trees.end(), forest.nodes()[m.node].tree))
      motion->position[m.node] = m.multiplier * motion->position[m.master] + m.offset;
  forTrees(island.model, island.team, [&](int tree) {
    const ForestTree& t = forest.trees()[tree];
    const Vector3 reference = motion->reference[tree];
    const Vector3 com = reference + motion->tree_com[tree] + dt * linear(motion->momentum[tree]) / motion->composite[t.first_node].mass;
    placeBodies(forest, tree, motion);
    computeInertias(forest, tree, motion);
    if (!t.free) return;
    if (flies && !isFast(*motion, tree) && t.node_end - t.first_node > 1) followMomentum(forest, tree, com, motion);
    motion->momentum[tree] = moveWrench(motion->momentum[tree], reference - motion->reference[tree]);
  });
  const auto tooFast = [&](int tree) { return motion->pace[tree] == Pace::TOO_FAST; };
  if (std::any_of(island.model.trees.begin(), island.model.trees.end(), tooFast)) brake(forest, island.model.trees, motion, space);
}

}  // namespace blem_sim::dynamics
