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

// A block for every tree, or trees that mimic joints tie, and for every pair of them that contacts or loops tie.
void IslandHessian::lay() {
  SolverSpace& s = *island_->space;
  const std::vector<int>& trees = island_->model.trees;
  joinTrees();
  block_sizes_.assign(tree_blocks_.number(), 0);
  for (std::size_t i = 0; i < trees.size(); ++i) s.block[trees[i]] = tree_blocks_.islandOf(static_cast<int>(i));
  for (const int k : iterate_->live().dofs()) s.block_row[k] = block_sizes_[s.block[treeOfDof(k)]]++;
  coupleTrees();
  if (block_vector_.size() < matrix_.size()) block_vector_.resize(matrix_.size());
}

void IslandHessian::joinTrees() {
  const std::vector<int>& trees = island_->model.trees;
  const auto placeOf = [&](int tree) { return static_cast<int>(std::lower_bound(trees.begin(), trees.end(), tree) - trees.begin()); };
  tree_blocks_.reset(island_->model.treeCount());
  for (const MimicFold& m : island_->model.mimics) tree_blocks_.join(placeOf(treeOfDof(m.dof)), placeOf(treeOfDof(m.master)));
}

void IslandHessian::coupleTrees() {
  const std::vector<int>& block = island_->space->block;
  matrix_.start(block_sizes_);
  const auto couple = [&](const BodyPair& pair) {
    if (pair.b < 0) return;
    const int a = block[treeOf(pair.a)], b = block[treeOf(pair.b)];
    if (a != b) matrix_.couple(a, b);
  };
  for (const PairContacts& p : island_->model.pairs) couple(p.pair);
  for (const BodyPair& pair : island_->model.loop_pairs) couple(pair);
  matrix_.analyse();
}

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
  coupleBlocks(pair, stiffness * x);
}

void IslandHessian::coupleBlocks(const BodyPair& pair, const Matrix6& stiffness) {
  const SolverSpace& s = *island_->space;
  const ForestNode &a = island_->forest.nodes()[pair.a], &b = island_->forest.nodes()[pair.b];
  if (a.last_dof < 0 || b.last_dof < 0) return;
  const int block_a = s.block[a.tree], block_b = s.block[b.tree];
  bool transposed = false;
  BlockMatrix::Block block = block_a == block_b ? matrix_.diagonal(block_a) : matrix_.coupling(block_a, block_b, &transposed);
  if (a.joint < 0 && b.joint < 0 && block_a != block_b) {  // free bodies: their subspaces are the axes
    const int r = s.block_row[a.first_dof], c = s.block_row[b.first_dof];
    if (transposed)
      block.block<6, 6>(c, r) -= stiffness.transpose();
    else
      block.block<6, 6>(r, c) -= stiffness;
    return;
  }
  for (int e = 0; e < island_->forest.rowLength(a.last_dof); ++e) {
    const int k = island_->forest.columns(a.last_dof)[e], r = s.block_row[k];
    const Vector6 row = stiffness.transpose() * island_->motion.subspace[k];
    for (int f = 0; f < island_->forest.rowLength(b.last_dof); ++f) {
      const int j = island_->forest.columns(b.last_dof)[f], c = s.block_row[j];
      const double value = row.dot(island_->motion.subspace[j]);
      // A diagonal block keeps its lower triangle only; a dof that carries both nodes gets both halves.
      if (block_a == block_b)
        block(std::max(r, c), std::min(r, c)) -= r == c ? 2 * value : value;
      else
        (transposed ? block(c, r) : block(r, c)) -= value;
    }
  }
}

// Adds the stiffnesses of contacts and loops at the present iterate to the bodies.
void IslandHessian::addStiffness() {
  const std::vector<PairContacts>& pairs = island_->model.pairs;
  for (const int i : iterate_->live().nodes()) island_->space->stiff[i] = 0;
  if (tied_) matrix_.setZero();
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

void IslandHessian::fillMatrix() {
  const SolverSpace& s = *island_->space;
  for (const int k : iterate_->live().dofs()) {
    BlockMatrix::Block h = matrix_.diagonal(s.block[treeOfDof(k)]);
    const double* packed = s.hessian.rows.data() + island_->forest.rowStart(k);
    for (int e = 0; e < island_->forest.rowLength(k); ++e) h(s.block_row[k], s.block_row[island_->forest.columns(k)[e]]) += packed[e];
  }
  for (const MimicFold& m : island_->model.mimics)
    matrix_.fold(s.block[treeOfDof(m.dof)], s.block_row[m.dof], s.block_row[m.master], m.multiplier);
}

bool IslandHessian::factor() {
  if (tied_ && state_ == State::NEW) lay();
  state_ = State::LAID;
  startFromBase();
  noteKinds();
  addStiffness();
  pushStiffness();
  if (tied_) fillMatrix();
  if (!(tied_ ? matrix_.factor(island_->team) : eliminateTrees())) return false;
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

void IslandHessian::solveBlocks() {
  SolverSpace& s = *island_->space;
  Eigen::Ref<Eigen::VectorXd> x = block_vector_.head(matrix_.size());
  const auto rowOf = [&](int dof) { return matrix_.offset(s.block[treeOfDof(dof)]) + s.block_row[dof]; };
  for (const MimicFold& m : island_->model.mimics) {
    s.direction[m.master] += m.multiplier * s.direction[m.dof];
    s.direction[m.dof] = 0;
  }
  for (const int k : iterate_->live().dofs()) x[rowOf(k)] = s.direction[k];
  matrix_.solve(x);
  for (const int k : iterate_->live().dofs()) s.direction[k] = x[rowOf(k)];
  for (const MimicFold& m : island_->model.mimics) s.direction[m.dof] = m.multiplier * s.direction[m.master];
}

void IslandHessian::findDirection() {
  SolverSpace& s = *island_->space;
  for (const int k : iterate_->live().dofs()) s.direction[k] = -s.gradient[k];
  if (tied_) return solveBlocks();
  for (const int tree : island_->model.trees) {
    reduce(island_->forest, tree, s.hessian, &s.direction, &s.paths);
    substitute(island_->forest, tree, s.hessian, &s.direction, &s.paths);
  }
}

}  // namespace blem_sim::dynamics
