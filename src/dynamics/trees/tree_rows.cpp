#include "trees/tree_rows.h"

#include <algorithm>
#include <cmath>

#include "lanes/lanes.h"

namespace blem_sim::dynamics {
namespace {

static_assert(Forest::ROW_UNIT == LANES, "rows are worked on in whole units");

/** Start of a tree's part of the work space: no path is longer than the tree has dofs, up to whole units. */
std::size_t partOf(const Forest& forest, int tree) { return forest.trees()[tree].first_dof + static_cast<std::size_t>(LANES) * tree; }

void clear(const Forest& forest, int tree, std::vector<double>* part) {
  std::fill_n(part->begin() + partOf(forest, tree), forest.trees()[tree].dofCount() + LANES, 0.0);
}

/** to += factor * row, in whole units. */
inline __attribute__((always_inline)) void addTo(double factor, const double* __restrict row, int length, double* __restrict to) {
  for (int e = 0; e < length; e += LANES)
    for (int lane = 0; lane < LANES; ++lane) to[e + lane] += factor * row[e + lane];
}

inline __attribute__((always_inline)) double rowDot(const double* __restrict row, int length, const double* __restrict path) {
  Lanes sums = {};
  for (int e = 0; e < length; e += LANES)
    for (int lane = 0; lane < LANES; ++lane) sums[lane] += row[e + lane] * path[e + lane];
  return sum(sums);
}

}  // namespace

void TreePaths::resize(const Forest& forest) {
  const std::size_t size = forest.dofCount() + LANES * forest.trees().size();
  values.assign(size, 0);
  sums.assign(size, 0);
  dofs.assign(size, 0);
}

void TreeFactor::resize(const Forest& forest) {
  rows.assign(forest.entryCount(), 0);
  inverse.assign(forest.dofCount(), 0);
}

BLEM_SIM_LANES void multiply(const TreeMatrix& matrix, const Eigen::VectorXd& v, Eigen::VectorXd* out, TreePaths* paths) {
  const auto [forest, tree, rows, chosen] = matrix;
  const ForestTree& t = forest.trees()[tree];
  clear(forest, tree, &paths->values);
  clear(forest, tree, &paths->sums);
  double *path = paths->values.data() + partOf(forest, tree), *sums = paths->sums.data() + partOf(forest, tree);
  int *dofs = paths->dofs.data() + partOf(forest, tree), depth = 0;
  // The sum of a dof's descendants is its own when the path leaves it.
  const auto leave = [&](int length) {
    for (; depth > length; --depth) {
      (*out)[dofs[depth - 1]] += sums[depth - 1];
      sums[depth - 1] = 0;
    }
  };
  for (int k = t.first_dof; k < t.dof_end; ++k) {
    if (chosen && !(*chosen)[forest.nodeOfDof(k)]) continue;
    const double* row = rows.data() + forest.rowStart(k);
    const int length = forest.rowLength(k);
    leave(length - 1);
    depth = length;
    dofs[length - 1] = k;
    path[length - 1] = v[k];
    (*out)[k] = rowDot(row, length, path);
    addTo(v[k], row, length, sums);
    sums[length - 1] = 0;
  }
  leave(0);
}

double dotProduct(const Forest& forest, const std::vector<int>& trees, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (const int tree : trees) {
    const ForestTree& t = forest.trees()[tree];
    sum += a.segment(t.first_dof, t.dofCount()).dot(b.segment(t.first_dof, t.dofCount()));
  }
  return sum;
}

BLEM_SIM_LANES bool eliminate(const Forest& forest, int dof, TreeFactor* factor) {
  const int* column = forest.columns(dof);
  double* row = factor->rows.data() + forest.rowStart(dof);
  const int last = forest.rowLength(dof) - 1, end = forest.rowEnd(dof) - forest.rowStart(dof);
  if (!(row[last] > 0)) return false;
  const double inverse = factor->inverse[dof] = 1 / std::sqrt(row[last]);
  for (int e = 0; e < last; ++e) row[e] *= inverse;
  for (int e = last; e < end; ++e) row[e] = 0;
  // The ancestor's row has the same columns as the beginning of this one; numbers written behind its end do not count.
  for (int i = 0; i < last; ++i) addTo(-row[i], row, i + 1, factor->rows.data() + forest.rowStart(column[i]));
  return true;
}

BLEM_SIM_LANES void reduce(const Forest& forest, int tree, const TreeFactor& factor, Eigen::VectorXd* x, TreePaths* paths) {
  const ForestTree& t = forest.trees()[tree];
  clear(forest, tree, &paths->sums);
  double *sums = paths->sums.data() + partOf(forest, tree), *v = x->data();
  for (int k = t.dof_end - 1; k >= t.first_dof; --k) {
    const int length = forest.rowLength(k);
    v[k] -= sums[length - 1];
    sums[length - 1] = 0;
    if (factor.inverse[k] == 0) continue;
    v[k] *= factor.inverse[k];
    addTo(v[k], factor.rows.data() + forest.rowStart(k), length, sums);
  }
}

BLEM_SIM_LANES void substitute(const Forest& forest, int tree, const TreeFactor& factor, Eigen::VectorXd* x, TreePaths* paths) {
  const ForestTree& t = forest.trees()[tree];
  clear(forest, tree, &paths->values);
  double *path = paths->values.data() + partOf(forest, tree), *v = x->data();
  for (int k = t.first_dof; k < t.dof_end; ++k) {
    const int length = forest.rowLength(k);
    if (factor.inverse[k] != 0) v[k] = (v[k] - rowDot(factor.rows.data() + forest.rowStart(k), length, path)) * factor.inverse[k];
    path[length - 1] = v[k];
  }
}

void factorTree(const TreeMatrix& matrix, TreeFactor* factor) {
  const Forest& forest = matrix.forest;
  const ForestTree& t = forest.trees()[matrix.tree];
  if (t.dofCount() == 0) return;
  const int first = forest.rowStart(t.first_dof), end = forest.rowEnd(t.dof_end - 1);
  std::copy(matrix.rows.begin() + first, matrix.rows.begin() + end, factor->rows.begin() + first);
  for (int k = t.dof_end - 1; k >= t.first_dof; --k) eliminate(forest, k, factor);
}

void solveTree(const Forest& forest, int tree, const TreeFactor& factor, Eigen::VectorXd* x, TreePaths* paths) {
  reduce(forest, tree, factor, x, paths);
  substitute(forest, tree, factor, x, paths);
}

}  // namespace blem_sim::dynamics
