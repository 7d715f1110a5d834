// Packed matrices along a tree: products, and factorisation without fill-in [Featherstone 2008, 6.5], H = L' L, dof by dof, descendants
// first.
#pragma once

#include <vector>

#include "trees/forest.h"

namespace blem_sim::dynamics {

/** Work space: values along the path from the root to the dof at hand, each tree in its own part. */
struct TreePaths {
  std::vector<double> values, sums;
  std::vector<int> dofs;

  void resize(const Forest& forest);
};

/** A factor, or the beginning of one. */
struct TreeFactor {
  std::vector<double> rows;     ///< of an eliminated dof: that of L, zero on the diagonal and in the room behind it
  std::vector<double> inverse;  ///< per dof: of the diagonal of L; 0: not eliminated

  void resize(const Forest& forest);
};

/** A packed matrix M on the dofs of a tree. */
struct TreeMatrix {
  const Forest& forest;
  int tree;
  const std::vector<double>& rows;            ///< zero in the room at their ends
  const std::vector<char>* chosen = nullptr;  ///< per node, those whose dofs are meant, their ancestors among them; null: all
};

/** out = M v on the dofs of a tree. */
void multiply(const TreeMatrix& matrix, const Eigen::VectorXd& v, Eigen::VectorXd* out, TreePaths* paths);

/** Factors M on all dofs of a tree. Precondition: it is positive definite. */
void factorTree(const TreeMatrix& matrix, TreeFactor* factor);

/** Solves in place on the dofs of a tree that factorTree factored. */
void solveTree(const Forest& forest, int tree, const TreeFactor& factor, Eigen::VectorXd* x, TreePaths* paths);

/** a . b on the dofs of some trees. */
double dotProduct(const Forest& forest, const std::vector<int>& trees, const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/** Eliminates a dof: its row's outer product is subtracted from its ancestors' rows. @return false if H is not positive definite */
bool eliminate(const Forest& forest, int dof, TreeFactor* factor);

/** Forward elimination: takes the eliminated dofs' shares from the right-hand side x of a tree. */
void reduce(const Forest& forest, int tree, const TreeFactor& factor, Eigen::VectorXd* x, TreePaths* paths);

/** The solution on the eliminated dofs, x holding that of the others. */
void substitute(const Forest& forest, int tree, const TreeFactor& factor, Eigen::VectorXd* x, TreePaths* paths);

}  // namespace blem_sim::dynamics
