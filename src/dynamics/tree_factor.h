// Factorisation of a packed matrix along a tree, without fill-in [Featherstone 2008, 6.5].
#pragma once

#include <vector>

#include "forest.h"

namespace blem_sim {

/** H = L' L in place, on the rows of one tree. @return false if H is not positive definite */
bool factorTree(const Forest& forest, int tree, std::vector<double>* rows);

/** x = H^-1 x on the dofs of the tree, with its factor. */
void solveTree(const Forest& forest, int tree, const std::vector<double>& rows, Eigen::VectorXd* x);

}  // namespace blem_sim
