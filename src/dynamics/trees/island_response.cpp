#include "trees/island_response.h"

#include <Eigen/LU>
#include <algorithm>

namespace blem_sim::dynamics {
namespace {

using ColumnsMap = Eigen::Map<Eigen::MatrixXd>;
using ConstColumnsMap = Eigen::Map<const Eigen::MatrixXd>;

bool isFreeBody(const Forest& forest, int tree) {
  const ForestTree& t = forest.trees()[tree];
  return t.free && t.node_end - t.first_node == 1;
}

}  // namespace

void IslandResponse::start(const Forest& forest, const ForestMotion& motion, const std::vector<int>& trees,
                           const std::vector<MimicFold>& mimics) {
  forest_ = &forest;
  motion_ = &motion;
  mimics_ = &mimics;
  trees_ = trees;
  mover_.assign(trees.size(), -1);
  free_.clear();
  unit_count_ = 0;
  columns_.clear();
  known_.clear();
  const auto placeOf = [&](int dof) {
    const int tree = forest.nodes()[forest.nodeOfDof(dof)].tree;
    return static_cast<std::size_t>(std::lower_bound(trees.begin(), trees.end(), tree) - trees.begin());
  };
  // Trees that mimic joints tie take the place of the first of them.
  std::vector<int>& unit = mover_;
  for (std::size_t i = 0; i < trees.size(); ++i) unit[i] = static_cast<int>(i);
  const auto root = [&](std::size_t i) {
    while (unit[i] != static_cast<int>(i)) i = unit[i];
    return static_cast<int>(i);
  };
  for (const MimicFold& m : mimics) {
    const int a = root(placeOf(m.dof)), b = root(placeOf(m.master));
    unit[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const ForestTree& t = forest.trees()[trees[i]];
    if (unit[i] == static_cast<int>(i) && isFreeBody(forest, trees[i])) {
      const SpatialInertia& inertia = motion.inertia[t.first_node];
      unit[i] = static_cast<int>(free_.size());
      free_.push_back({t.first_dof, 1 / inertia.mass, inertia.rotational.inverse()});
      continue;
    }
    if (unit[i] == static_cast<int>(i)) {
      unit[i] = -1 - unit_count_++;
      if (static_cast<int>(units_.size()) < unit_count_) units_.emplace_back();
      units_[unit_count_ - 1].dofs.clear();
    } else {
      unit[i] = unit[unit[i]];
    }
    for (int k = t.first_dof; k < t.dof_end; ++k) units_[-1 - unit[i]].dofs.push_back(k);
  }
}

bool IslandResponse::factor(const Eigen::VectorXd& gains) {
  columns_.clear();
  known_.clear();
  for (int u = 0; u < unit_count_; ++u)
    if (!units_[u].factor(*forest_, *motion_, gains, *mimics_)) return false;
  return true;
}

int IslandResponse::unitOf(int node) const {
  const auto place = std::lower_bound(trees_.begin(), trees_.end(), forest_->nodes()[node].tree) - trees_.begin();
  return -1 - mover_[place];
}

ResponseSide IslandResponse::side(int node) {
  ResponseSide side;
  side.node = node;
  if (node < 0) return side;
  const auto place = std::lower_bound(trees_.begin(), trees_.end(), forest_->nodes()[node].tree) - trees_.begin();
  if (mover_[place] >= 0) {
    side.base = mover_[place];
    side.first_dof = free_[side.base].first_dof;
    return side;
  }
  side.unit = -1 - mover_[place];
  for (const KnownColumns& known : known_)
    if (known.node == node) {
      side.base = known.base;
      return side;
    }
  const ResponseUnit& unit = units_[side.unit];
  side.base = columns_.size();
  known_.push_back({node, side.base});
  columns_.resize(side.base + 6 * static_cast<std::size_t>(unit.size()), 0);
  ColumnsMap columns(columns_.data() + side.base, unit.size(), 6);
  columns.setZero();
  const int last = forest_->nodes()[node].last_dof;
  for (int e = 0; last >= 0 && e < forest_->rowLength(last); ++e) {
    const int dof = forest_->columns(last)[e];
    columns.row(unit.rowOf(dof)) = motion_->subspace[dof].transpose();
  }
  unit.solve(columns.data(), 6);
  return side;
}

std::size_t IslandResponse::column(int dof) {
  const ResponseUnit& unit = units_[unitOf(forest_->nodeOfDof(dof))];
  const std::size_t base = columns_.size();
  columns_.resize(base + unit.size(), 0);
  std::fill(columns_.begin() + base, columns_.end(), 0.0);
  columns_[base + unit.rowOf(dof)] = 1;
  unit.solve(columns_.data() + base, 1);
  return base;
}

int IslandResponse::moverOf(const ResponseSide& side) const {
  return side.unit < 0 ? static_cast<int>(side.base) : freeBodies() + side.unit;
}

Vector6 IslandResponse::twist(const ResponseSide& side, const Eigen::VectorXd& velocity) const {
  if (side.unit < 0) return velocity.segment<6>(side.first_dof);
  Vector6 twist = Vector6::Zero();
  const int last = forest_->nodes()[side.node].last_dof;
  for (int e = 0; last >= 0 && e < forest_->rowLength(last); ++e) {
    const int dof = forest_->columns(last)[e];
    twist += velocity[dof] * motion_->subspace[dof];
  }
  return twist;
}

void IslandResponse::push(const ResponseSide& side, const Vector6& wrench, Eigen::VectorXd* velocity) const {
  if (side.unit < 0) {
    const FreeBody& body = free_[side.base];
    velocity->segment<3>(side.first_dof) += body.inverse_inertia * angular(wrench);
    velocity->segment<3>(side.first_dof + 3) += body.inverse_mass * linear(wrench);
    return;
  }
  const ResponseUnit& unit = units_[side.unit];
  const double* column = columns_.data() + side.base;
  const int n = unit.size();
  for (int d = 0; d < 6; ++d, column += n)
    for (int r = 0; r < n; ++r) (*velocity)[unit.dofs[r]] += column[r] * wrench[d];
}

ResponsePair IslandResponse::pair(const BodyPair& pair) { return {pair, side(pair.a), side(pair.b)}; }

Vector6 IslandResponse::relativeTwist(const ResponsePair& pair, const Eigen::VectorXd& velocity) const {
  const Vector6 a = twist(pair.a, velocity);
  if (pair.b.node < 0) return a;
  return a - moveTwist(twist(pair.b, velocity), -pair.pair.shift);
}

void IslandResponse::push(const ResponsePair& pair, const Vector6& wrench, Eigen::VectorXd* velocity) const {
  push(pair.a, wrench, velocity);
  if (pair.b.node >= 0) push(pair.b, -moveWrench(wrench, -pair.pair.shift), velocity);
}

void IslandResponse::setLane(const ResponseSide& side, int lane, int first, BodyLanes* bodies) const {
  const FreeBody* body = side.node < 0 ? nullptr : &free_[side.base];
  bodies->first[lane] = first;
  bodies->inverse_mass[lane] = body ? body->inverse_mass : 0;
  for (int r = 0, at = 0; r < 3; ++r)
    for (int c = 0; c <= r; ++c, ++at) bodies->inverse_inertia[at][lane] = body ? body->inverse_inertia(r, c) : 0;
}

void IslandResponse::push(int unit, std::size_t column, double impulse, Eigen::VectorXd* velocity) const {
  const std::vector<int>& dofs = units_[unit].dofs;
  for (std::size_t r = 0; r < dofs.size(); ++r) (*velocity)[dofs[r]] += columns_[column + r] * impulse;
}

// Twist of one side to a wrench on the other, each about its own reference point.
Matrix6 IslandResponse::between(const ResponseSide& of, const ResponseSide& to) const {
  Matrix6 out = Matrix6::Zero();
  if (of.unit < 0) {
    const FreeBody& body = free_[of.base];
    out.topLeftCorner<3, 3>() = body.inverse_inertia;
    out.bottomRightCorner<3, 3>().diagonal().setConstant(body.inverse_mass);
    return out;
  }
  const ResponseUnit& unit = units_[to.unit];
  const ConstColumnsMap columns(columns_.data() + to.base, unit.size(), 6);
  const int last = forest_->nodes()[of.node].last_dof;
  for (int e = 0; last >= 0 && e < forest_->rowLength(last); ++e) {
    const int dof = forest_->columns(last)[e];
    const Eigen::Matrix<double, 1, 6> row = columns.row(unit.rowOf(dof));  // as long as it is: products of it need no memory
    out += motion_->subspace[dof] * row;
  }
  return out;
}

Matrix6 IslandResponse::relative(const ResponsePair& pair) const {
  const ResponseSide &a = pair.a, &b = pair.b;
  Matrix6 out = between(a, a);
  if (b.node < 0) return out;
  // A wrench about a's reference point, about b's; its transpose moves twists back.
  Matrix6 move = Matrix6::Identity();
  move.topRightCorner<3, 3>() = crossMatrix(-pair.pair.shift);
  out += move.transpose() * between(b, b) * move;
  if (a.unit < 0 || a.unit != b.unit) return out;
  const Matrix6 cross = between(a, b) * move;
  return out - cross - cross.transpose();
}

void IslandResponse::freeVelocity(const Eigen::VectorXd& momentum, Eigen::VectorXd* velocity) {
  for (const FreeBody& body : free_) {
    velocity->segment<3>(body.first_dof) = body.inverse_inertia * momentum.segment<3>(body.first_dof);
    velocity->segment<3>(body.first_dof + 3) = body.inverse_mass * momentum.segment<3>(body.first_dof + 3);
  }
  for (int u = 0; u < unit_count_; ++u) {
    const ResponseUnit& unit = units_[u];
    right_hand_side_.resize(unit.size());
    for (int r = 0; r < unit.size(); ++r) right_hand_side_[r] = momentum[unit.dofs[r]];
    unit.solve(right_hand_side_.data(), 1);
    for (int r = 0; r < unit.size(); ++r) (*velocity)[unit.dofs[r]] = right_hand_side_[r];
  }
}

}  // namespace blem_sim::dynamics
