#include "island/tree_state.h"

namespace blem_sim::dynamics {

void saveTree(const Forest& forest, int tree, const ForestMotion& motion, geometry::StateWriter* writer) {
  const ForestTree& t = forest.trees()[tree];
  writer->numbers(motion.rotation[t.first_node].data(), 9);
  writer->vector(motion.origin[t.first_node]);
  writer->numbers(motion.momentum[tree].data(), 6);
  writer->numbers(motion.position.data() + t.first_node, t.node_end - t.first_node);
  writer->numbers(motion.velocity.data() + t.first_dof, t.dofCount());
  writer->numbers(motion.change.data() + t.first_dof, t.dofCount());
  writer->numbers(motion.owed.data() + t.first_dof, t.dofCount());
}

void restoreTree(const Forest& forest, int tree, ForestMotion* motion, geometry::StateReader* reader) {
  const ForestTree& t = forest.trees()[tree];
  reader->numbers(motion->rotation[t.first_node].data(), 9);
  motion->origin[t.first_node] = reader->vector();
  reader->numbers(motion->momentum[tree].data(), 6);
  reader->numbers(motion->position.data() + t.first_node, t.node_end - t.first_node);
  reader->numbers(motion->velocity.data() + t.first_dof, t.dofCount());
  reader->numbers(motion->change.data() + t.first_dof, t.dofCount());
  reader->numbers(motion->owed.data() + t.first_dof, t.dofCount());
  placeBodies(forest, tree, motion);
  computeInertias(forest, tree, motion);
}

bool standsAt(const Forest& forest, int tree, const ForestMotion& motion, const Scene& scene) {
  constexpr double ROUNDING = 1e-6;  // of turns, of a metre, and of the way from the origin
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    const int body = forest.nodes()[i].body;
    const Vector3 com = scene.com(body), way = motion.reference[tree] + motion.com[i] - com;
    if (!((motion.rotation[i] - scene.rotation(body)).cwiseAbs().maxCoeff() <= ROUNDING)) return false;
    if (!(way.norm() <= ROUNDING * (1 + com.norm()))) return false;
  }
  return true;
}

}  // namespace blem_sim::dynamics
