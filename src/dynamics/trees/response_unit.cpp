#include "trees/response_unit.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace blem_sim::dynamics {
namespace {

using DenseMap = Eigen::Map<Eigen::MatrixXd>;
using ConstDenseMap = Eigen::Map<const Eigen::MatrixXd>;

}  // namespace

int ResponseUnit::rowOf(int dof) const { return static_cast<int>(std::lower_bound(dofs.begin(), dofs.end(), dof) - dofs.begin()); }

bool ResponseUnit::factor(const Forest& forest, const ForestMotion& motion, const Eigen::VectorXd& gains,
                          const std::vector<MimicFold>& mimics) {
  const int n = size();
  matrix_.assign(static_cast<std::size_t>(n) * n, 0);
  DenseMap m(matrix_.data(), n, n);
  for (int r = 0; r < n; ++r) {
    const int dof = dofs[r];
    const double* row = motion.mass.data() + forest.rowStart(dof);
    for (int e = 0; e < forest.rowLength(dof); ++e) {
      const int c = rowOf(forest.columns(dof)[e]);
      m(r, c) = m(c, r) = row[e];
    }
    m(r, r) += gains[dof];
  }
  folds_.clear();
  for (const MimicFold& fold : mimics) {
    if (!std::binary_search(dofs.begin(), dofs.end(), fold.dof)) continue;
    const int from = rowOf(fold.dof), to = rowOf(fold.master);
    m.row(to) += fold.multiplier * m.row(from);
    m.col(to) += fold.multiplier * m.col(from);
    m.row(from).setZero();
    m.col(from).setZero();
    m(from, from) = 1;
    folds_.push_back({from, to, fold.multiplier});
  }
  Eigen::Ref<Eigen::MatrixXd> whole(m);
  return Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower>(whole).info() == Eigen::Success;
}

void ResponseUnit::solve(double* values, int columns) const {
  const int n = size();
  const ConstDenseMap l(matrix_.data(), n, n);
  DenseMap x(values, n, columns);
  for (const Fold& f : folds_) {
    x.row(f.master) += f.multiplier * x.row(f.row);
    x.row(f.row).setZero();
  }
  for (int c = 0; c < columns; ++c) {
    auto one = x.col(c);
    l.triangularView<Eigen::Lower>().solveInPlace(one);
    l.transpose().triangularView<Eigen::Upper>().solveInPlace(one);
  }
  for (const Fold& f : folds_) x.row(f.row) = f.multiplier * x.row(f.master);
}

}  // namespace blem_sim::dynamics
