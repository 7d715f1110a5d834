#include "newton/island_hessian.h"

#include <algorithm>

namespace blem_sim::dynamics {
namespace {

/** Twists about b's reference point to those about a's. */
Matrix6 shiftMatrix(const Vector3& shift) {
  Matrix6 x = Matrix6::Identity();
  x.bottomLeftCorner<3, 3>() = crossMatrix(shift);
  return x;
}

}  // namespace

void IslandHessian::start(const IslandAtHand& island, const IslandIterate& iterate) {
  island_ = &island;
  iterate_ = &iterate;
  tied_ = island.model.isTied();
}

void IslandHessian::forget() {
  state_ = State::NEW;
  for (const int k : iterate_->live().idleDofs()) island_->space->hessian.inverse[k] = 0;
}

void IslandHessian::forgetFactor() { state_ = std::min(state_, State::LAID); }

void IslandHessian::stiffen(int node, const Matrix6& stiffness) {
  SolverSpace& s = *island_->space;
  if (s.stiff[node])
    s.stiffness[node] += stiffness;
  else
    s.stiffness[node] = stiffness;
  s.stiff[node] = 1;
}

void IslandHessian::stiffenPair(const BodyPair& pair, const Matrix6& stiffness) {
  stiffen(pair.a, stiffness);
  if (pair.b < 0) return;
  const Matrix6 x = shiftMatrix(pair.shift);
  stiffen(pair.b, x.transpose() * stiffness * x);
  blocks_.tie(pair, stiffness * x);
}

// Adds the stiffnesses of contacts and loops at the present iterate to the bodies.
void IslandHessian::addStiffness() {
  const std::vector<PairContacts>& pairs = island_->model.pairs;
  for (const int i : iterate_->live().nodes()) island_->space->stiff[i] = 0;
  if (tied_) blocks_.setZero();
  pair_stiffness_.resize(pairs.size());
  pair_is_stiff_.resize(pairs.size());
  forPairs(*island_, [&](std::size_t p) { pair_is_stiff_[p] = iterate_->reactions().contacts().stiffnessOf(p, &pair_stiffness_[p]); });
  for (std::size_t p = 0; p < pairs.size(); ++p)
    if (pair_is_stiff_[p]) stiffenPair(pairs[p].pair, pair_stiffness_[p]);
  const std::vector<LoopTerm>& loops = island_->terms()->loops;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    Vector6 gain;
    for (int r = 0; r < 6; ++r) gain[r] = loops[l].stiffness(r, loops[l].velocity[r]);
    stiffenPair(island_->model.loop_pairs[l], loops[l].basis * gain.asDiagonal() * loops[l].basis.transpose());
  }
}

// The bodies' stiffnesses are pushed to the root like inertias: the sparsity stays that of M.
void IslandHessian::pushStiffness() {
  SolverSpace& s = *island_->space;
  const std::vector<int>& nodes = iterate_->live().nodes();
  for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) {
    if (!s.stiff[*i]) continue;
    const ForestNode& node = island_->forest.nodes()[*i];
    const bool free = island_->forest.trees()[node.tree].free;
    for (int d = 0; d < node.dofs; ++d) {
      const int k = node.first_dof + d, length = island_->forest.rowLength(k);
      const int* column = island_->forest.columns(k);
      double* row = s.hessian.rows.data() + island_->forest.rowStart(k);
      const Vector6 pushed = s.stiffness[*i] * island_->motion.subspace[k];
      const int unit = free ? std::min(6, length) : 0;
      for (int e = 0; e < unit; ++e) row[e] += pushed[e];
      for (int e = unit; e < length; ++e) row[e] += pushed.dot(island_->motion.subspace[column[e]]);
    }
    if (node.parent >= 0) stiffen(node.parent, s.stiffness[*i]);
  }
}

bool IslandHessian::factor() {
  if (tied_ && state_ == State::NEW) blocks_.lay(*island_, iterate_->live().dofs());
  state_ = State::LAID;
  startFromBase();
  noteKinds();
  addStiffness();
  pushStiffness();
  if (tied_) blocks_.add(island_->space->hessian.rows);
  if (!(tied_ ? blocks_.factor() : eliminateTrees())) return false;
  state_ = State::FACTORED;
  return true;
}

// M as the elimination of idle dofs has left it, and the joints' stiffnesses.
void IslandHessian::startFromBase() {
  SolverSpace& s = *island_->space;
  const Forest& forest = island_->forest;
  const double* base = s.idle.rows.data();
  for (const int k : iterate_->live().dofs())
    std::copy(base + forest.rowStart(k), base + forest.rowEnd(k), s.hessian.rows.data() + forest.rowStart(k));
  iterate_->reactions().joints().forLive(
      [&](const JointBlock& block, int lane, int dof) { s.hessian.rows[forest.diagonal(dof)] += block.stiffness[lane]; });
}

void IslandHessian::noteKinds() {
  joint_stiffness_.clear();
  const IslandJoints& joints = iterate_->reactions().joints();
  for (const JointBlock* b = joints.liveBegin(); b != joints.liveEnd(); ++b)
    joint_stiffness_.insert(joint_stiffness_.end(), b->stiffness, b->stiffness + LANES);
  kinds_.clear();
  for (const ContactBlock& b : iterate_->reactions().contacts().blocks()) kinds_.insert(kinds_.end(), b.kind, b.kind + LANES);
}

bool IslandHessian::eliminateTrees() {
  const std::vector<int>& dofs = iterate_->live().dofs();
  return std::all_of(dofs.rbegin(), dofs.rend(), [&](int k) { return eliminate(island_->forest, k, &island_->space->hessian); });
}

bool IslandHessian::isCurrent() const {
  if (!isFactored()) return false;
  const double *kind = kinds_.data(), *stiffness = joint_stiffness_.data();
  for (const ContactBlock& b : iterate_->reactions().contacts().blocks())
    for (int lane = 0; lane < LANES; ++lane)
      if (b.kind[lane] != *kind++) return false;
  const IslandJoints& joints = iterate_->reactions().joints();
  for (const JointBlock* b = joints.liveBegin(); b != joints.liveEnd(); ++b)
    for (int lane = 0; lane < LANES; ++lane)
      if (b->stiffness[lane] != *stiffness++) return false;
  return true;
}

void IslandHessian::findDirection() {
  SolverSpace& s = *island_->space;
  for (const int k : iterate_->live().dofs()) s.direction[k] = -s.gradient[k];
  if (tied_) return blocks_.solve(&s.direction);
  for (const int tree : island_->model.trees) {
    reduce(island_->forest, tree, s.hessian, &s.direction, &s.paths);
    substitute(island_->forest, tree, s.hessian, &s.direction, &s.paths);
  }
}

}  // namespace blem_sim::dynamics
