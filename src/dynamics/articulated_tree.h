// A kinematic tree in joint coordinates: kinematics, mass matrix, bias forces. World axes; every twist and wrench of a tree is taken about
// one fixed point, the tree's reference point, so that inertias and forces simply add up along the tree.
#pragma once

#include <vector>

#include "scene.h"

namespace blem_sim {

/** Angular part first, linear part (velocity of the reference point, or force) last. */
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/** Rigid body inertia about the reference point, world axes: sums of bodies are sums of these ten numbers. */
struct SpatialInertia {
  double mass = 0;
  Vector3 first_moment = Vector3::Zero();  ///< mass * com [kg m]
  Matrix3 rotational = Matrix3::Zero();    ///< [kg m^2] about the reference point

  void add(const SpatialInertia& o) {
    mass += o.mass;
    first_moment += o.first_moment;
    rotational += o.rotational;
  }
  /** Momentum (angular about the reference point, linear) of a body that moves with twist v. */
  Vector6 times(const Vector6& v) const;
};

/** One body and the joint that moves it. Nodes are numbered parents first, in depth-first order. */
struct TreeNode {
  int body = 0;
  int parent = -1;  ///< node, -1 for the root
  int joint = -1;   ///< world joint that moves it; -1: the free root
  JointKind kind = JointKind::FIXED;
  Pose X_JC = Pose::Identity();  ///< child body against the joint frame at position 0
  int first_dof = 0;             ///< index of its first degree of freedom in the tree
  int dofs = 0;                  ///< 6 for a free root, 1 for a moving joint, 0 for a fixed one
};

/** Where a tree's bodies are and how they move; everything about the reference point. */
struct TreeState {
  Vector3 reference = Vector3::Zero();  ///< in the world: a free root's centre of mass, else the root's origin
  std::vector<Pose> X_WB;               ///< per node
  std::vector<Vector6> twist;           ///< per node
  std::vector<SpatialInertia> inertia;  ///< per node
  std::vector<Vector6> subspace;        ///< per dof: the twist of unit velocity
};

/** Structure of one tree; built once, when bodies or joints change. */
class ArticulatedTree {
 public:
  /** @param root body without a moving parent: free, or held to the world by its joint */
  ArticulatedTree(const Scene& scene, int root);

  int dofCount() const { return dof_count_; }
  const std::vector<TreeNode>& nodes() const { return nodes_; }
  bool isFree() const { return nodes_.front().joint < 0; }
  int dofNode(int dof) const { return dof_node_[dof]; }
  /** The dof that comes before this one on the way to the root, -1 at the root. */
  int dofParent(int dof) const { return dof_parent_[dof]; }
  /** The last dof on the way from a node to the root (the node's own if it has one), -1 if none moves it. */
  int lastDof(int node) const { return last_dof_[node]; }

  /** Reads positions (joints only) from the poses of the world's bodies, and velocities of all dofs. */
  void read(const Scene& scene, std::vector<double>* positions, Eigen::VectorXd* velocity, Pose* root_pose) const;
  /** Sets the bodies of the scene to the state. */
  void write(const TreeState& state, Scene* scene) const;
  /** Poses, twists, inertias and motion subspaces. @param positions per node, of its joint */
  void kinematics(const Scene& scene, const Pose& root_pose, const std::vector<double>& positions, const Eigen::VectorXd& velocity,
                  TreeState* state) const;
  /** Twists of the nodes and the velocity products that go with them, for other velocities at the same poses. */
  void setVelocity(const Eigen::VectorXd& velocity, TreeState* state) const;
  /** Generalized bias: velocity products, gravity and the bodies' pending wrenches, so that M dv/dt = forces - bias. */
  void bias(const Scene& scene, const TreeState& state, Eigen::VectorXd* out) const;
  /** Joint space inertia, lower triangle where rows have ancestors, zero elsewhere; dense storage. */
  void massMatrix(const TreeState& state, Eigen::MatrixXd* out) const;

 private:
  void addNode(const Scene& scene, int body, int parent, int joint);

  std::vector<TreeNode> nodes_;
  std::vector<int> dof_node_, dof_parent_, last_dof_;
  int dof_count_ = 0;
};

}  // namespace blem_sim
