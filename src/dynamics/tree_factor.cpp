#include "tree_factor.h"

#include <cmath>

namespace blem_sim {

bool factorTree(const Forest& forest, int tree, std::vector<double>* rows) {
  const ForestTree& t = forest.trees()[tree];
  for (int k = t.dof_end - 1; k >= t.first_dof; --k) {
    const int* column = forest.columns(k);
    double* row = rows->data() + forest.rowStart(k);
    const int last = forest.rowLength(k) - 1;
    if (!(row[last] > 0)) return false;
    row[last] = std::sqrt(row[last]);
    const double inverse = 1 / row[last];
    for (int e = 0; e < last; ++e) row[e] *= inverse;
    // The ancestor's row has the same columns as the beginning of this one.
    for (int i = 0; i < last; ++i) {
      double* __restrict above = rows->data() + forest.rowStart(column[i]);
      const double* __restrict own = row;
      const double factor = row[i];
      for (int e = 0; e <= i; ++e) above[e] -= factor * own[e];
    }
  }
  return true;
}

void solveTree(const Forest& forest, int tree, const std::vector<double>& rows, Eigen::VectorXd* x) {
  const ForestTree& t = forest.trees()[tree];
  double* v = x->data();
  for (int k = t.dof_end - 1; k >= t.first_dof; --k) {
    const int* column = forest.columns(k);
    const double* row = rows.data() + forest.rowStart(k);
    const int last = forest.rowLength(k) - 1;
    v[k] /= row[last];
    for (int e = 0; e < last; ++e) v[column[e]] -= row[e] * v[k];
  }
  for (int k = t.first_dof; k < t.dof_end; ++k) {
    const int* column = forest.columns(k);
    const double* row = rows.data() + forest.rowStart(k);
    const int last = forest.rowLength(k) - 1;
    double sum = v[k];
    for (int e = 0; e < last; ++e) sum -= row[e] * v[column[e]];
    v[k] = sum / row[last];
  }
}

}  // namespace blem_sim
