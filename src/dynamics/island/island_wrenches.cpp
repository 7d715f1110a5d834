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

/** Wrench through a node's joint, about its origin. @param through about the tree's reference @param arm to that from the origin */
Wrench atJoint(const Vector6& through, const Vector3& arm) {
  const Vector6 at_origin = moveWrench(through, arm);
  return {linear(at_origin), angular(at_origin)};
}

/** An island's motion at the start of its way, room to reckon in, and the wrenches that are asked for. */
struct WrenchBooks {
  const SolvedIsland& island;
  ForestMotion* motion;
  SolverSpace* space;
  std::vector<Wrench>* wrenches;
};

// Wrenches of a tree's joints in the solve: of the change of its velocities, less what acts on the bodies from outside and in contacts; and
// what its joints pay for the way before.
void setSolvedWrenches(const WrenchBooks& books, int tree) {
  const auto& [island, motion, space, wrenches] = books;
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
    Vector6 through = motion->node_change[i];
    if (node.parent >= 0) motion->node_change[node.parent] += through;
    if (node.joint < 0) continue;
    if (motion->pace[tree] != Pace::FAST) through += motion->node_force[i];
    (*wrenches)[node.joint] = atJoint(through, motion->reference[tree] - motion->joint_origin[i]);
  }
}

// Adds what keeps a fast tree's joints together on its free way, from momenta at both ends, at the middle of the way, without what joints
// that keep their velocities owe to the next step. Overwrites the space's twists and wrenches.
void addWayWrenches(const WrenchBooks& books, const FreeMotion& way, int tree) {
  const auto& [island, motion, space, wrenches] = books;
  const Forest& forest = island.forest;
  const ForestTree& t = forest.trees()[tree];
  computeTwists(forest, tree, *motion, space->velocity, &space->twist);
  for (int i = t.first_node; i < t.node_end; ++i) space->wrench[i] = way.momentumRate(forest, i, island.dt, *motion, space->twist[i]);
  for (int i = t.node_end - 1; i >= t.first_node; --i) {
    const ForestNode& node = forest.nodes()[i];
    if (node.parent >= 0) space->wrench[node.parent] += space->wrench[i];
    if (node.joint < 0) continue;
    Wrench& wrench = (*wrenches)[node.joint];
    const Wrench added = atJoint(space->wrench[i], motion->reference[tree] - way.middleJoint(i, *motion));
    wrench.force += added.force;
    wrench.torque += added.torque;
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
  const WrenchBooks books{island, motion, space, wrenches};
  for (const int tree : island.model.trees) {
    setSolvedWrenches(books, tree);
    if (motion->pace[tree] == Pace::FAST) addWayWrenches(books, way, tree);
  }
}

}  // namespace blem_sim::dynamics
