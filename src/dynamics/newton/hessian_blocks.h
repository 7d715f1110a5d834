// The Hessian of trees that are tied, as a matrix of blocks: one per limb, and one per two limbs of which one carries the other or that
// something ties.
#pragma once

#include <vector>

#include "problem/island_at_hand.h"
#include "trees/block_matrix.h"
#include "trees/islands.h"

namespace blem_sim::dynamics {

/**
 * A limb is the dofs from one branching of a tree to the next; all dofs of a free body. So what touches a foot is coupled with the leg and
 * the root alone. Trees with mimic joints, which tie any two of their dofs, are one block each.
 */
class HessianBlocks {
 public:
  /** Makes the blocks. @param dofs the live ones, ascending; it and the island are kept until the next call */
  void lay(const IslandAtHand& island, const std::vector<int>& dofs);
  void setZero() { matrix_.setZero(); }
  /** Subtracts what a stiffness between two bodies makes the dofs of one feel of those of the other. */
  void tie(const BodyPair& pair, const Matrix6& stiffness);
  /** Adds packed rows, as the forest has them, and folds mimic joints into their masters. */
  void add(const std::vector<double>& rows);
  /** @return false if it is not positive definite */
  bool factor() { return matrix_.factor(island_->team); }
  /** Solves in place. @param x by dof. Precondition: factored */
  void solve(Eigen::VectorXd* x);

 private:
  /** Part of the matrix: rows of one block, columns of another one. */
  struct Cells {
    double* first;
    Eigen::Index down, across;  // to the next row, to the next column

    double& at(int row, int column) { return first[row * down + column * across]; }
  };
  int treeOfDof(int dof) const { return island_->forest.nodes()[island_->forest.nodeOfDof(dof)].tree; }
  int placeOfDof(int dof) const;
  int parentOf(int dof) const;
  void joinTrees();
  void findLimbs();
  void couplePaths(int dof_a, int dof_b);
  void coupleAll();
  Cells cells(int dof_a, int dof_b);
  void tieFree(const ForestNode& a, const ForestNode& b, const Matrix6& stiffness);
  void tiePaths(int dof_a, int dof_b, const Matrix6& stiffness);

  const IslandAtHand* island_ = nullptr;
  const std::vector<int>* dofs_ = nullptr;
  Islands joined_;                // trees, by place in the island, that mimic joints tie
  std::vector<int> whole_;        // per group of joined trees: its block if it is one, else -1
  std::vector<int> children_;     // per dof: the live ones that it carries directly
  std::vector<int> block_, row_;  // per dof
  std::vector<int> sizes_;
  BlockMatrix matrix_;
  Eigen::VectorXd vector_;
};

}  // namespace blem_sim::dynamics
