// The kinematic trees of a scene: robots, free bodies, chains that the world holds. Structure only; built when bodies or joints change.
#pragma once

#include <vector>

#include "lanes/spatial.h"
#include "scene/scene.h"

namespace blem_sim::dynamics {

/** One body and the joint that moves it. Nodes of a tree are consecutive, parents first, depth first. */
struct ForestNode {
  int body = 0;
  int tree = 0;
  int parent = -1;  ///< node, -1 for a root
  int joint = -1;   ///< world joint that moves it; -1: a free root
  JointKind kind = JointKind::FIXED;
  Pose X_PJ = Pose::Identity();  ///< joint frame on the parent (or in the world)
  Pose X_JC = Pose::Identity();  ///< child body against the joint frame at position 0
  Vector3 axis = Vector3::UnitZ();
  geometry::MassProperties inertial;
  double armature = 0;
  int first_dof = 0;  ///< index of its first degree of freedom
  int dofs = 0;       ///< 6 for a free root, 1 for a moving joint, 0 for a fixed one
  int last_dof = -1;  ///< the last dof on the way from the root to here, its own included; -1 if none moves it
};

struct ForestTree {
  int first_node = 0, node_end = 0;
  int first_dof = 0, dof_end = 0;
  bool free = false;

  int dofCount() const { return dof_end - first_dof; }
};

/** q = multiplier * q of master + offset; the master follows nothing itself. Nodes of the forest. */
struct MimicRelation {
  int node, master;
  double multiplier = 1, offset = 0;
};

/** A joint that closes a loop, between two nodes. */
struct LoopClosure {
  int joint = -1;
  int child = -1, parent = -1;  ///< nodes; parent -1: the world
  JointKind kind = JointKind::FIXED;
  Pose X_PJ = Pose::Identity();  ///< joint frame on the parent
  Pose X_CJ = Pose::Identity();  ///< and on the child, at position 0
  Vector3 axis = Vector3::UnitZ();
};

/**
 * Matrices over the dofs of the forest that couple a dof only with its ancestors are stored as packed rows: row k holds its columns from
 * the root to k itself, so that an ancestor's row has the same columns as the beginning of a descendant's. Room is left at a row's end up
 * to a multiple of ROW_UNIT.
 */
class Forest {
 public:
  /** Builds the trees anew from the scene. */
  void build(const Scene& scene);

  const std::vector<ForestNode>& nodes() const { return nodes_; }
  const std::vector<ForestTree>& trees() const { return trees_; }
  const std::vector<MimicRelation>& mimics() const { return mimics_; }
  const std::vector<LoopClosure>& loops() const { return loops_; }
  int dofCount() const { return static_cast<int>(dof_node_.size()); }
  int nodeOfBody(int body) const { return body_node_[body]; }
  int nodeOfDof(int dof) const { return dof_node_[dof]; }

  static constexpr int ROW_UNIT = 4;
  int rowStart(int dof) const { return row_start_[dof]; }
  int rowLength(int dof) const { return row_length_[dof]; }
  int rowEnd(int dof) const { return row_start_[dof + 1]; }  ///< with the room left
  int diagonal(int dof) const { return row_start_[dof] + row_length_[dof] - 1; }
  /** Columns of packed row `dof`: dofs from the root to it. */
  const int* columns(int dof) const { return columns_.data() + row_start_[dof]; }
  int entryCount() const { return row_start_.back(); }

 private:
  void addTree(const Scene& scene, int root);
  void addNode(const Scene& scene, int body, int parent, int joint);
  void addDofs(ForestNode* node, int index);
  void findMimics(const Scene& scene);
  void findJoints(const Scene& scene);

  std::vector<ForestNode> nodes_;
  std::vector<ForestTree> trees_;
  std::vector<MimicRelation> mimics_;
  std::vector<LoopClosure> loops_;
  std::vector<int> body_node_, dof_node_;
  std::vector<int> body_joint_, first_joint_, next_joint_;  // while it is built: of a tree, by child, by parent and one after another
  std::vector<int> row_start_, row_length_, columns_;
};

/** Calls visit(dof, dof of the master, multiplier) for each joint of a tree that follows another. */
template <typename Visit>
void forFollowers(const Forest& forest, int tree, const Visit& visit) {
  for (const MimicRelation& m : forest.mimics())
    if (forest.nodes()[m.node].tree == tree) visit(forest.nodes()[m.node].first_dof, forest.nodes()[m.master].first_dof, m.multiplier);
}

}  // namespace blem_sim::dynamics
