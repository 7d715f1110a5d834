#include "problem/impact_rows.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr double IMMOVABLE_POINT = 1e-12;  // [1/kg]

}  // namespace

ImpactRows::Entry ImpactRows::begin() const {
  Entry entry;
  entry.first_side = entry.side_end = static_cast<int>(sides_.size());
  return entry;
}

void ImpactRows::addSides(const Source& s, int tree, Entry* entry) {
  for (const int moved : s.mass->movedWith(tree)) {
    const ForestTree& t = s.forest.trees()[moved];
    sides_.push_back({moved, t.first_dof, t.dofCount(), static_cast<int>(numbers_.size())});
    numbers_.resize(numbers_.size() + 6 * t.dofCount(), 0.0);
    entry->dofs += t.dofCount();
  }
  entry->side_end = static_cast<int>(sides_.size());
}

const ImpactRows::Side& ImpactRows::sideOf(int tree, const Entry& entry) const {
  int side = entry.first_side;
  while (sides_[side].tree != tree) ++side;
  return sides_[side];
}

// Adds the motion of a partner's point to the rows of its tree.
void ImpactRows::fill(const Source& s, const Partner& partner, const Vector3& point, const Entry& entry) {
  const ForestNode& node = s.forest.nodes()[partner.node];
  if (node.last_dof < 0) return;
  const Side& side = sideOf(node.tree, entry);
  for (int d = 0; d < 3; ++d) {
    const Vector6 wrench = moveWrench(wrenchOf(entry.basis.col(d), point), -partner.shift);
    double* row = numbers_.data() + side.rows + d * side.dofs - side.first_dof;
    for (int e = 0; e < s.forest.rowLength(node.last_dof); ++e) {
      const int k = s.forest.columns(node.last_dof)[e];
      row[k] += partner.sign * s.motion.subspace[k].dot(wrench);
    }
  }
}

// Columns of the trees that move with one.
void ImpactRows::respond(const Source& s, int tree, const Entry& entry) {
  for (int d = 0; d < 3; ++d) {
    for (const int moved : s.mass->movedWith(tree)) {
      const Side& side = sideOf(moved, entry);
      std::copy_n(numbers_.data() + side.rows + d * side.dofs, side.dofs, s.space->column.data() + side.first_dof);
    }
    s.mass->solve(s.forest, tree, &s.space->column, s.space);
    for (const int moved : s.mass->movedWith(tree)) {
      const Side& side = sideOf(moved, entry);
      std::copy_n(s.space->column.data() + side.first_dof, side.dofs, numbers_.data() + side.rows + (3 + d) * side.dofs);
    }
  }
}

Matrix3 ImpactRows::response(const Entry& entry) const {
  Matrix3 sum = Matrix3::Zero();
  for (int s = entry.first_side; s < entry.side_end; ++s) {
    const Eigen::Map<const Eigen::MatrixXd> rows(numbers_.data() + sides_[s].rows, sides_[s].dofs, 6);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum(i, j) += rows.col(i).dot(rows.col(3 + j));
  }
  return sum;
}

int ImpactRows::add(const Source& s, const BodyPair& pair, const ContactTerm& term) {
  Entry entry = begin();
  const Vector3 across = term.normal.unitOrthogonal();
  entry.basis << term.normal, across, term.normal.cross(across);
  const int tree_a = s.forest.nodes()[pair.a].tree, tree_b = pair.b >= 0 ? s.forest.nodes()[pair.b].tree : -1;
  const bool apart = pair.b >= 0 && s.mass->unitOf(tree_b) != s.mass->unitOf(tree_a);
  addSides(s, tree_a, &entry);
  if (apart) addSides(s, tree_b, &entry);
  fill(s, {pair.a, Vector3::Zero(), 1}, term.point, entry);
  if (pair.b >= 0) fill(s, {pair.b, pair.shift, -1}, term.point, entry);
  respond(s, tree_a, entry);
  if (apart) respond(s, tree_b, entry);
  const Matrix3 m = response(entry);
  const double mean = 0.5 * (m(1, 1) + m(2, 2));
  const double across_most = mean + std::hypot(0.5 * (m(1, 1) - m(2, 2)), m(1, 2));
  entry.normal = m(0, 0) > IMMOVABLE_POINT ? m(0, 0) : 0;
  entry.across = across_most > IMMOVABLE_POINT ? across_most : 0;
  contacts_.push_back(entry);
  return static_cast<int>(contacts_.size()) - 1;
}

int ImpactRows::addLimit(const Source& s, int dof, double sign) {
  Entry entry = begin();
  const int tree = s.forest.nodes()[s.forest.nodeOfDof(dof)].tree;
  addSides(s, tree, &entry);
  const Side& side = sideOf(tree, entry);
  numbers_[side.rows + dof - side.first_dof] = sign;
  respond(s, tree, entry);
  entry.normal = response(entry)(0, 0);
  contacts_.push_back(entry);
  return static_cast<int>(contacts_.size()) - 1;
}

Vector3 ImpactRows::velocity(int contact, const Eigen::VectorXd& v) const {
  const Entry& entry = contacts_[contact];
  Vector3 sum = Vector3::Zero();
  for (int s = entry.first_side; s < entry.side_end; ++s) {
    const Side& side = sides_[s];
    const double* row = numbers_.data() + side.rows;
    for (int d = 0; d < 3; ++d)
      for (int k = 0; k < side.dofs; ++k) sum[d] += *row++ * v[side.first_dof + k];
  }
  return sum;
}

void ImpactRows::push(int contact, const Vector3& impulse, Eigen::VectorXd* v) const {
  const Entry& entry = contacts_[contact];
  for (int s = entry.first_side; s < entry.side_end; ++s) {
    const Side& side = sides_[s];
    const double* column = numbers_.data() + side.rows + 3 * side.dofs;
    for (int d = 0; d < 3; ++d)
      for (int k = 0; k < side.dofs; ++k) (*v)[side.first_dof + k] += *column++ * impulse[d];
  }
}

void ImpactRows::addMomentum(int contact, const Vector3& impulse, Eigen::VectorXd* momentum) const {
  const Entry& entry = contacts_[contact];
  for (int s = entry.first_side; s < entry.side_end; ++s) {
    const Side& side = sides_[s];
    const double* row = numbers_.data() + side.rows;
    for (int d = 0; d < 3; ++d)
      for (int k = 0; k < side.dofs; ++k) (*momentum)[side.first_dof + k] += *row++ * impulse[d];
  }
}

}  // namespace blem_sim::dynamics
