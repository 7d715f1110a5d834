// Accelerations of a tree under its velocity products alone, body by body from the leaves to the root [Featherstone 2008, 7.3].
#pragma once

#include "trees/forest_motion.h"

namespace blem_sim::dynamics {

/** Nothing acts from outside. Held dofs keep their velocities; joints that follow others of the tree do so by efforts that do no work.
 *  Trees share nothing that they write. */
class ArticulatedBodies {
 public:
  void resize(const Forest& forest);

  /** Per dof: whether it keeps its velocity. */
  std::vector<char> held;
  /** Takes a tree, whose joints follow each other unless they are held. */
  void start(const Forest& forest, int tree);
  /** Fills accelerations, efforts and drift. @param at bodies and twists at an instant */
  void accelerate(const Forest& forest, int tree, ForestMotion* at);

  /** Per dof. */
  const Eigen::VectorXd& acceleration() const { return acceleration_; }
  /** [N m or N] Effort by which a dof keeps its velocity, follows another dof, or leads one; else 0. */
  double effort(int dof) const { return effort_[dof]; }

 private:
  /** A dof that follows another one. */
  struct Tie {
    int dof, master;
    double multiplier;
  };
  /** Ties within one tree. */
  struct TreeTies {
    std::vector<Tie> all, kept;  // kept: of dofs that are not held
    Eigen::MatrixXd strays;      // accelerations by which ties are missed, by a unit effort of each
    Eigen::VectorXd wanted;      // effort by tie
  };
  bool turns(const ForestNode& node) const { return node.dofs == 1 && !held[node.first_dof]; }
  void articulateAll(const Forest& forest, int tree, const ForestMotion& at);
  void articulate(const Forest& forest, int node, const ForestMotion& at);
  void solve(const Forest& forest, int tree, bool moves, ForestMotion* at);
  void collect(const Forest& forest, int node, const ForestMotion& at);
  void findEfforts(const Forest& forest, int tree, ForestMotion* at);
  void relax(int tree);
  void addEffort(const Tie& tie, double effort);

  // Per node.
  std::vector<Matrix6> articulated_;
  std::vector<Vector6> bias_, pull_, node_acceleration_;
  // Per dof.
  std::vector<double> lack_, inverse_;
  Eigen::VectorXd acceleration_, effort_;
  std::vector<TreeTies> ties_;  // per tree
};

}  // namespace blem_sim::dynamics
