#include "problem/impact_rows.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr double IMMOVABLE_POINT = 1e-12;  // [1/kg]

}  // namespace

void ImpactSpace::resize(const Forest& forest) {
  for (auto* v : {&velocity, &leap, &momentum, &column}) v->setZero(forest.dofCount());
  factor.resize(forest);
  paths.resize(forest);
  twist.resize(forest.nodes().size());
}

void ImpactRows::clear() {
  contacts_.clear();
  numbers_.clear();
}

void ImpactRows::addSide(const Forest& forest, int tree, Entry* entry) {
  const ForestTree& t = forest.trees()[tree];
  entry->sides[entry->side_count++] = {t.first_dof, t.dofCount(), static_cast<int>(numbers_.size())};
  numbers_.resize(numbers_.size() + 6 * t.dofCount(), 0.0);
}

// Adds the motion of a partner's point to the rows of the last side.
void ImpactRows::fill(const Forest& forest, const ForestMotion& motion, const Partner& partner, const Vector3& point, const Entry& entry) {
  const int last = forest.nodes()[partner.node].last_dof;
  if (last < 0) return;
  const Side& side = entry.sides[entry.side_count - 1];
  for (int d = 0; d < 3; ++d) {
    const Vector6 wrench = moveWrench(wrenchOf(entry.basis.col(d), point), -partner.shift);
    double* row = numbers_.data() + side.rows + d * side.dofs - side.first_dof;
    for (int e = 0; e < forest.rowLength(last); ++e) {
      const int k = forest.columns(last)[e];
      row[k] += partner.sign * motion.subspace[k].dot(wrench);
    }
  }
}

void ImpactRows::respond(const Forest& forest, int tree, const Side& side, ImpactSpace* space) {
  for (int d = 0; d < 3; ++d) {
    const double* row = numbers_.data() + side.rows + d * side.dofs;
    std::copy(row, row + side.dofs, space->column.data() + side.first_dof);
    solveTree(forest, tree, space->factor, &space->column, &space->paths);
    std::copy_n(space->column.data() + side.first_dof, side.dofs, numbers_.data() + side.rows + (3 + d) * side.dofs);
  }
}

int ImpactRows::add(const Forest& forest, const ForestMotion& motion, const BodyPair& pair, const ContactTerm& term, ImpactSpace* space) {
  Entry entry;
  const Vector3 across = term.normal.unitOrthogonal();
  entry.basis << term.normal, across, term.normal.cross(across);
  const int tree_a = forest.nodes()[pair.a].tree, tree_b = pair.b >= 0 ? forest.nodes()[pair.b].tree : -1;
  addSide(forest, tree_a, &entry);
  fill(forest, motion, {pair.a, Vector3::Zero(), 1}, term.point, entry);
  if (pair.b >= 0) {
    if (tree_b != tree_a) addSide(forest, tree_b, &entry);
    fill(forest, motion, {pair.b, pair.shift, -1}, term.point, entry);
  }
  respond(forest, tree_a, entry.sides[0], space);
  if (entry.side_count > 1) respond(forest, tree_b, entry.sides[1], space);
  Matrix3 response = Matrix3::Zero();
  for (int s = 0; s < entry.side_count; ++s) {
    const int dofs = entry.sides[s].dofs;
    const Eigen::Map<const Eigen::MatrixXd> rows(numbers_.data() + entry.sides[s].rows, dofs, 6);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) response(i, j) += rows.col(i).dot(rows.col(3 + j));
  }
  const double mean = 0.5 * (response(1, 1) + response(2, 2));
  const double across_most = mean + std::hypot(0.5 * (response(1, 1) - response(2, 2)), response(1, 2));
  entry.normal = response(0, 0) > IMMOVABLE_POINT ? response(0, 0) : 0;
  entry.across = across_most > IMMOVABLE_POINT ? across_most : 0;
  contacts_.push_back(entry);
  return static_cast<int>(contacts_.size()) - 1;
}

Vector3 ImpactRows::velocity(int contact, const Eigen::VectorXd& v) const {
  const Entry& entry = contacts_[contact];
  Vector3 sum = Vector3::Zero();
  for (int s = 0; s < entry.side_count; ++s) {
    const Side& side = entry.sides[s];
    const double* row = numbers_.data() + side.rows;
    for (int d = 0; d < 3; ++d)
      for (int k = 0; k < side.dofs; ++k) sum[d] += *row++ * v[side.first_dof + k];
  }
  return sum;
}

void ImpactRows::push(int contact, const Vector3& impulse, Eigen::VectorXd* v) const {
  const Entry& entry = contacts_[contact];
  for (int s = 0; s < entry.side_count; ++s) {
    const Side& side = entry.sides[s];
    const double* column = numbers_.data() + side.rows + 3 * side.dofs;
    for (int d = 0; d < 3; ++d)
      for (int k = 0; k < side.dofs; ++k) (*v)[side.first_dof + k] += *column++ * impulse[d];
  }
}

void ImpactRows::addMomentum(int contact, const Vector3& impulse, Eigen::VectorXd* momentum) const {
  const Entry& entry = contacts_[contact];
  for (int s = 0; s < entry.side_count; ++s) {
    const Side& side = entry.sides[s];
    const double* row = numbers_.data() + side.rows;
    for (int d = 0; d < 3; ++d)
      for (int k = 0; k < side.dofs; ++k) (*momentum)[side.first_dof + k] += *row++ * impulse[d];
  }
}

}  // namespace blem_sim::dynamics
