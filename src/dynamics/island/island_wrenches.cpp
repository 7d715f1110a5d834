#include "island/island_wrenches.h"

namespace blem_sim::dynamics {
namespace {

// Wrenches on the nodes from contacts, and from loops whose joints' wrenches are noted on the way, about the trees' reference points.
void addReactions(const SolvedIsland& island, const ForestMotion& motion, std::vector<Vector6>* on_node, std::vector<Wrench>* wrenches) {
  const double dt = island.dt;
  const std::vector<ContactTerm>& contacts = island.found.contacts;
  for (const PairContacts& of_pair : island.model.pairs)
    for (int i = of_pair.first; i < of_pair.end; ++i)
      addWrench(of_pair.pair, wrenchOf(contacts[i].impulse / dt, contacts[i].point), on_node);
  for (std::size_t l = 0; l < island.found.loops.size(); ++l) {
    const LoopTerm& loop = island.found.loops[l];
    const BodyPair& pair = island.model.loop_pairs[l];
    const Vector6 wrench = loop.basis * loop.impulses() / dt;
    addWrench(pair, wrench, on_node);
    const Vector6 at_origin = moveWrench(wrench, motion.reference[island.forest.nodes()[pair.a].tree] - loop.origin);
    (*wrenches)[loop.drive.joint] = {linear(at_origin), angular(at_origin)};
  }
}

// A tree that has followed its free motion through the step.
struct FastTree {
  const SolvedIsland& island;
  int tree;
  const FreeMotion& way;
  const ForestMotion& motion;
};

// Wrenches of a fast tree's joints, from momenta at the start and at the end; forces act at the middle of the way. Overwrites on_node.
void addFastWrenches(const FastTree& fast, std::vector<Vector6>* on_node, std::vector<Wrench>* wrenches) {
  const auto& [island, tree, way, motion] = fast;
  const Forest& forest = island.forest;
  const Scene& scene = island.scene;
  const double dt = island.dt;
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.node_end - 1; i >= t.first_node; --i) {
    const ForestNode& node = forest.nodes()[i];
    const Wrench& pending = scene.bodies()[node.body].pending;
    const Vector3 middle = way.middleCom(i, motion), force = node.inertial.mass * scene.gravity() + pending.force;
    Vector6& through = (*on_node)[i];
    through = moveWrench(through, middle - motion.com[i]);
    through += spatial(middle.cross(force) + pending.torque, force);
    through = way.momentumRate(forest, i, dt, motion) - through;
  }
  for (int i = t.node_end - 1; i >= t.first_node; --i) {
    const ForestNode& node = forest.nodes()[i];
    if (node.parent >= 0) (*on_node)[node.parent] += (*on_node)[i];
    if (node.joint < 0) continue;
    const Vector6 at_origin = moveWrench((*on_node)[i], motion.reference[tree] - way.middleJoint(i, motion));
    (*wrenches)[node.joint] = {linear(at_origin), angular(at_origin)};
  }
}

// Wrenches of a slow tree's joints: of the mean acceleration over the step, less what acts on the bodies from outside and in contacts.
void addSlowWrenches(const SolvedIsland& island, int tree, ForestMotion* motion, SolverSpace* space, std::vector<Wrench>* wrenches) {
  const Forest& forest = island.forest;
  const Scene& scene = island.scene;
  const double dt = island.dt;
  const ForestTree& t = forest.trees()[tree];
  space->gradient.segment(t.first_dof, t.dofCount()) =
      (motion->next_velocity.segment(t.first_dof, t.dofCount()) - motion->velocity.segment(t.first_dof, t.dofCount())) / dt;
  for (int i = t.first_node; i < t.node_end; ++i) computeTwist(forest, i, *motion, space->gradient, &motion->node_change);
  for (int i = t.node_end - 1; i >= t.first_node; --i) {
    const ForestNode& node = forest.nodes()[i];
    const Wrench& pending = scene.bodies()[node.body].pending;
    const Vector3 outside = node.inertial.mass * scene.gravity() + pending.force;
    // Wrench through the joint, less the velocity products of the bodies that it carries, which are summed already.
    Vector6& through = motion->node_change[i];
    through = motion->inertia[i].times(through) - space->wrench[i];
    through -= spatial(motion->com[i].cross(outside) + pending.torque, outside);
  }
  for (int i = t.node_end - 1; i >= t.first_node; --i) {
    const ForestNode& node = forest.nodes()[i];
    const Vector6& through = motion->node_change[i];
    if (node.parent >= 0) motion->node_change[node.parent] += through;
    if (node.joint < 0) continue;
    const Vector6 at_origin = moveWrench(through + motion->node_force[i], motion->reference[tree] - motion->joint_origin[i]);
    (*wrenches)[node.joint] = {linear(at_origin), angular(at_origin)};
  }
}

}  // namespace

void computeWrenches(const SolvedIsland& island, const FreeMotion& way, ForestMotion* motion, SolverSpace* space,
                     std::vector<Wrench>* wrenches) {
  std::vector<Vector6>& reaction = space->wrench;
  for (const int tree : island.model.trees) {
    const ForestTree& t = island.forest.trees()[tree];
    for (int i = t.first_node; i < t.node_end; ++i) reaction[i].setZero();
  }
  addReactions(island, *motion, &reaction, wrenches);
  for (const int tree : island.model.trees) {
    if (motion->pace[tree] == Pace::FAST)
      addFastWrenches({island, tree, way, *motion}, &reaction, wrenches);
    else
      addSlowWrenches(island, tree, motion, space, wrenches);
  }
}

}  // namespace blem_sim::dynamics
