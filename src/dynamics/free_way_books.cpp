#include "free_way_books.h"

namespace blem_sim::dynamics {
namespace {

// Adds, before and after the free way of fast trees, the terms of free_ways. @param sign -1 and 1 @param twist there
void addFreeWays(const SolvedIsland& island, const ForestMotion& motion, double sign, const std::vector<Vector6>& twist,
                 SolveResult* result) {
  for (const int tree : island.model.trees) {
    if (motion.pace[tree] != Pace::FAST) continue;
    const ForestTree& t = island.forest.trees()[tree];
    for (int i = t.first_node; i < t.node_end; ++i)
      result->free_ways[island.forest.nodes()[i].body] +=
          sign * (motion.reference[tree] + motion.com[i]) - 0.5 * island.dt * velocityAt(twist[i], motion.com[i]);
  }
}

/** Adds, before and after the free way of fast trees, the terms of free_speeds. @param sign -1 and 1 */
void addFreeSpeeds(const SolvedIsland& island, const ForestMotion& motion, double sign, SolveResult* result) {
  for (const int tree : island.model.trees) {
    if (motion.pace[tree] != Pace::FAST) continue;
    const ForestTree& t = island.forest.trees()[tree];
    for (int i = t.first_node; i < t.node_end; ++i) {
      const ForestNode& n = island.forest.nodes()[i];
      if (n.dofs != 1) continue;
      double& speed = result->free_speeds[n.joint];
      speed -= sign / island.dt * motion.position[i];
      if (sign > 0) speed += motion.velocity[n.first_dof];
    }
  }
}

/** Adds work(node, dof, effort) [J] of each joint of the island's trees, and what it owes, by its sign. */
template <typename Work>
void addFreeWork(const SolvedIsland& island, const ForestMotion& motion, double sign, const Work& work, SolveResult* result) {
  for (const int tree : island.model.trees) {
    const ForestTree& t = island.forest.trees()[tree];
    for (int i = t.first_node; i < t.node_end; ++i) {
      const ForestNode& n = island.forest.nodes()[i];
      if (n.dofs != 1) continue;
      result->free_work[n.joint] += work(i, n.first_dof, result->axis_efforts[n.joint]);
      result->free_efforts[n.joint] += sign * motion.owed[n.first_dof] / island.dt;
    }
  }
}

}  // namespace

bool hasFreeWays(const ForestMotion& motion) {
  for (std::size_t tree = 0; tree < motion.pace.size(); ++tree)
    if (motion.pace[tree] == Pace::FAST || motion.lead[tree].any()) return true;
  return false;
}

// Debts of the last step are paid along the mean velocity.
void bookBeforeWay(const SolvedIsland& island, const ForestMotion& motion, SolverSpace* space, SolveResult* result) {
  for (const int tree : island.model.trees)
    if (motion.pace[tree] == Pace::FAST) computeTwists(island.forest, tree, motion, space->velocity, &space->twist);
  addFreeWays(island, motion, -1, space->twist, result);
  addFreeSpeeds(island, motion, -1, result);
  const auto work = [&](int node, int k, double effort) {
    const double solved = motion.next_velocity[k];
    return effort * (motion.position[node] + 0.5 * island.dt * solved) - 0.5 * motion.owed[k] * (motion.velocity[k] + solved);
  };
  addFreeWork(island, motion, -1, work, result);
}

// Held joints went their way at the velocity that was solved.
void bookAfterWay(const SolvedIsland& island, const ForestMotion& motion, SolveResult* result) {
  addFreeWays(island, motion, 1, motion.twist, result);
  addFreeSpeeds(island, motion, 1, result);
  const auto work = [&](int node, int k, double effort) {
    return motion.owed[k] * motion.next_velocity[k] - effort * (motion.position[node] - 0.5 * island.dt * motion.velocity[k]);
  };
  addFreeWork(island, motion, 1, work, result);
}

}  // namespace blem_sim::dynamics
