#include "kept_trees.h"

#include <algorithm>

#include "island/tree_state.h"

namespace blem_sim::dynamics {
namespace {

bool isSame(const geometry::MassProperties& a, const geometry::MassProperties& b) {
  return a.mass == b.mass && a.com == b.com && a.inertia == b.inertia;
}

bool isSame(const ForestNode& a, const ForestNode& b) {
  return a.body == b.body && a.joint == b.joint && a.kind == b.kind && a.dofs == b.dofs && a.axis == b.axis && a.armature == b.armature &&
         a.X_PJ.matrix() == b.X_PJ.matrix() && a.X_JC.matrix() == b.X_JC.matrix() && isSame(a.inertial, b.inertial);
}

std::vector<ForestNode> nodesOf(const Forest& forest, int tree) {
  const ForestTree& t = forest.trees()[tree];
  return {forest.nodes().begin() + t.first_node, forest.nodes().begin() + t.node_end};
}

}  // namespace

void KeptTrees::keep(const Forest& forest, int tree, const ForestMotion& motion) {
  trees_.push_back({nodesOf(forest, tree), {}});
  geometry::StateWriter writer(&trees_.back().state);
  saveTree(forest, tree, motion, &writer);
}

bool KeptTrees::restore(const Forest& forest, int tree, ForestMotion* motion) const {
  const std::vector<ForestNode> nodes = nodesOf(forest, tree);
  const auto kept = std::partition_point(trees_.begin(), trees_.end(), [&](const Kept& k) { return k.nodes[0].body < nodes[0].body; });
  if (kept == trees_.end() || kept->nodes.size() != nodes.size()) return false;
  const auto same = [](const ForestNode& a, const ForestNode& b) { return isSame(a, b); };
  if (!std::equal(nodes.begin(), nodes.end(), kept->nodes.begin(), same)) return false;
  geometry::StateReader reader(kept->state);
  restoreTree(forest, tree, motion, &reader);
  return true;
}

}  // namespace blem_sim::dynamics
