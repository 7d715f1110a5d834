#include "island/flight.h"

#include <algorithm>
#include <cmath>

#include "island/tree_pace.h"
#include "scene/contact_motion.h"

namespace blem_sim::dynamics {
namespace {

constexpr double SLOW_STEPS = 2;  // contacts whose speed gravity gives in so many steps do not bounce

/** [s] By which velocities of the step stand farther before their poses than those of its part. */
double lag(double of_step, double dt) { return 0.5 * (of_step - dt); }

/** Whether a contact bears its bodies, or may do so at the end of the solve. One that bounces leaves them in flight. */
bool bears(const TermSource& s, const ContactConstraint& c) {
  if (s.memory.find(c.id)) return true;
  const double slow = SLOW_STEPS * s.input.of_step * s.scene.gravity().norm();
  const double closing = -c.normal_BA.dot(contactMotion(s.scene, c).velocity_BA);
  if (c.depth + s.input.dt * (closing + slow) < 0) return false;
  return !(c.restitution > 0 && std::abs(closing) > slow);
}

Vector3 comVelocity(const Vector6& momentum, const SpatialInertia& whole) { return linear(momentum) / whole.mass; }

void addVelocity(const Forest& forest, int tree, const Vector3& velocity, ForestMotion* motion) {
  const ForestTree& t = forest.trees()[tree];
  const SpatialInertia& whole = motion->composite[t.first_node];
  motion->velocity.segment<3>(t.first_dof + 3) += velocity;
  motion->momentum[tree] += spatial(whole.first_moment.cross(velocity), whole.mass * velocity);
  computeTwists(forest, tree, *motion, motion->velocity, &motion->twist);
}

/** Leads of all free trees, as if nothing bore them. */
void findLeads(const TermSource& s, const std::vector<int>& trees, ForestMotion* motion) {
  for (const int tree : trees) {
    const ForestTree& t = s.forest.trees()[tree];
    if (!t.free || isTied(s.forest, tree) || rootDriveOf(s.input, s.forest.nodes()[t.first_node].body) >= 0) continue;
    computeApplied(s.forest, s.scene, tree, motion);
    const double mass = motion->composite[t.first_node].mass;
    motion->lead[tree].velocity = lag(s.input.of_step, s.input.dt) / mass * motion->applied.segment<3>(t.first_dof + 3);
  }
}

}  // namespace

bool setOutInFlight(const TermSource& s, const Island& island, ForestMotion* motion) {
  for (const int tree : island.model.trees) motion->lead[tree] = Lead();
  if (!(s.input.of_step > s.input.dt)) return false;
  findLeads(s, island.model.trees, motion);
  for (const int index : island.contacts) {
    const ContactConstraint& c = s.input.contacts[index];
    if (!bears(s, c)) continue;
    for (const int body : {c.body_a, c.body_b})
      if (body != WORLD_BODY) motion->lead[s.forest.nodes()[s.forest.nodeOfBody(body)].tree] = Lead();
  }
  bool any = false;
  for (const int tree : island.model.trees) {
    Lead& lead = motion->lead[tree];
    if (!lead.any()) continue;
    any = true;
    lead.velocity_before = motion->velocity.segment<3>(s.forest.trees()[tree].first_dof + 3);
    lead.momentum_before = motion->momentum[tree];
    addVelocity(s.forest, tree, lead.velocity, motion);
  }
  return any;
}

bool hasLanded(const Island& island, const Forest& forest, const ForestMotion& motion) {
  const std::vector<ContactTerm>& contacts = island.solver.found().terms.contacts;
  const auto flies = [&](int node) { return node >= 0 && motion.lead[forest.nodes()[node].tree].any(); };
  const auto pushes = [](const ContactTerm& contact) { return !contact.impulse.isZero(0); };
  return std::any_of(island.model.pairs.begin(), island.model.pairs.end(), [&](const PairContacts& of_pair) {
    return (flies(of_pair.pair.a) || flies(of_pair.pair.b)) &&
           std::any_of(contacts.begin() + of_pair.first, contacts.begin() + of_pair.end, pushes);
  });
}

void breakOffFlight(const Forest& forest, const std::vector<int>& trees, ForestMotion* motion) {
  for (const int tree : trees) {
    Lead& lead = motion->lead[tree];
    if (!lead.any()) continue;
    motion->velocity.segment<3>(forest.trees()[tree].first_dof + 3) = lead.velocity_before;
    motion->momentum[tree] = lead.momentum_before;
    computeTwists(forest, tree, *motion, motion->velocity, &motion->twist);
    lead = Lead();
  }
}

// Weights are booked as if they had worked along what the lead is worth at both ends.
void endFlight(const SolvedIsland& island, double of_step, ForestMotion* motion, SolveResult* result) {
  for (const int tree : island.model.trees) {
    const Lead& lead = motion->lead[tree];
    if (!lead.any()) continue;
    const ForestTree& t = island.forest.trees()[tree];
    addVelocity(island.forest, tree, -lead.velocity, motion);
    const SpatialInertia& whole = motion->composite[t.first_node];
    const Vector3 change = comVelocity(motion->momentum[tree], whole) - comVelocity(lead.momentum_before, whole);
    for (int i = t.first_node; i < t.node_end; ++i) result->free_ways[island.forest.nodes()[i].body] += lag(of_step, island.dt) * change;
  }
}

}  // namespace blem_sim::dynamics
