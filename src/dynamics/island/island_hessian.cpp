// Hessian: M plus the stiffnesses of contacts, loops and joints; its factor, and the direction that follows from it.
#include <algorithm>

#include "island/island_problem.h"

namespace blem_sim::dynamics {
namespace {

/** Twists about b's reference point to those about a's. */
Matrix6 shiftMatrix(const Vector3& shift) {
  Matrix6 x = Matrix6::Identity();
  x.bottomLeftCorner<3, 3>() = crossMatrix(shift);
  return x;
}

}  // namespace

void IslandProblem::layBlocks() {
  SolverSpace& s = *space_;
  const auto treeOf = [&](int node) { return forest_->nodes()[node].tree; };
  const auto placeOf = [&](int tree) { return static_cast<int>(std::lower_bound(trees.begin(), trees.end(), tree) - trees.begin()); };
  tree_blocks_.reset(static_cast<int>(trees.size()));
  for (const MimicFold& m : mimics)
    tree_blocks_.join(placeOf(treeOf(forest_->nodeOfDof(m.dof))), placeOf(treeOf(forest_->nodeOfDof(m.master))));
  block_sizes_.assign(tree_blocks_.number(), 0);
  for (std::size_t i = 0; i < trees.size(); ++i) s.block[trees[i]] = tree_blocks_.islandOf(static_cast<int>(i));
  for (const int k : live_dofs_) s.block_row[k] = block_sizes_[s.block[treeOf(forest_->nodeOfDof(k))]]++;
  matrix_.start(block_sizes_);
  const auto couple = [&](const BodyPair& pair) {
    if (pair.b < 0) return;
    const int a = s.block[treeOf(pair.a)], b = s.block[treeOf(pair.b)];
    if (a != b) matrix_.couple(a, b);
  };
  for (const ContactPatch& p : patches) couple(p.pair);
  for (const BodyPair& pair : loop_pairs) couple(pair);
  matrix_.analyse();
  laid_ = true;
  if (block_vector_.size() < matrix_.size()) block_vector_.resize(matrix_.size());
}

void IslandProblem::stiffen(int node, const Matrix6& stiffness) {
  SolverSpace& s = *space_;
  if (s.stiff[node])
    s.stiffness[node] += stiffness;
  else
    s.stiffness[node] = stiffness;
  s.stiff[node] = 1;
}

void IslandProblem::stiffenPair(const BodyPair& pair, const Matrix6& stiffness) {
  stiffen(pair.a, stiffness);
  if (pair.b < 0) return;
  const Matrix6 x = shiftMatrix(pair.shift);
  stiffen(pair.b, x.transpose() * stiffness * x);
  coupleBlocks(pair, stiffness * x);
}

void IslandProblem::coupleBlocks(const BodyPair& pair, const Matrix6& stiffness) {
  const SolverSpace& s = *space_;
  const ForestNode &a = forest_->nodes()[pair.a], &b = forest_->nodes()[pair.b];
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
  for (int e = 0; e < forest_->rowLength(a.last_dof); ++e) {
    const int k = forest_->columns(a.last_dof)[e], r = s.block_row[k];
    const Vector6 row = stiffness.transpose() * motion_->subspace[k];
    for (int f = 0; f < forest_->rowLength(b.last_dof); ++f) {
      const int j = forest_->columns(b.last_dof)[f], c = s.block_row[j];
      const double value = row.dot(motion_->subspace[j]);
      // A diagonal block keeps its lower triangle only; a dof that carries both nodes gets both halves.
      if (block_a == block_b)
        block(std::max(r, c), std::min(r, c)) -= r == c ? 2 * value : value;
      else
        (transposed ? block(c, r) : block(r, c)) -= value;
    }
  }
}

// Adds the stiffnesses of contacts and loops at the present iterate to the bodies.
void IslandProblem::addStiffness() {
  for (const int i : live_nodes_) space_->stiff[i] = 0;
  if (coupled_) matrix_.setZero();
  patch_stiffness_.resize(patches.size());
  patch_is_stiff_.resize(patches.size());
  const ContactBlock* blocks = contact_blocks_.data();
  forPatches([&](std::size_t p) {
    patch_is_stiff_[p] = stiffnessOf(blocks + patches[p].first_block, blocks + patches[p].block_end, &patch_stiffness_[p]);
  });
  for (std::size_t p = 0; p < patches.size(); ++p)
    if (patch_is_stiff_[p]) stiffenPair(patches[p].pair, patch_stiffness_[p]);
  for (std::size_t l = 0; l < loops.size(); ++l) {
    Vector6 gain;
    for (int r = 0; r < 6; ++r) gain[r] = loops[l].stiffness(r, loops[l].velocity[r]);
    stiffenPair(loop_pairs[l], loops[l].basis * gain.asDiagonal() * loops[l].basis.transpose());
  }
}

// The bodies' stiffnesses are pushed to the root like inertias: the sparsity stays that of M.
void IslandProblem::pushStiffness() {
  SolverSpace& s = *space_;
  for (auto i = live_nodes_.rbegin(); i != live_nodes_.rend(); ++i) {
    if (!s.stiff[*i]) continue;
    const ForestNode& node = forest_->nodes()[*i];
    const bool free = forest_->trees()[node.tree].free;
    for (int d = 0; d < node.dofs; ++d) {
      const int k = node.first_dof + d, length = forest_->rowLength(k);
      const int* column = forest_->columns(k);
      double* row = s.hessian.rows.data() + forest_->rowStart(k);
      const Vector6 pushed = s.stiffness[*i] * motion_->subspace[k];
      const int unit = free ? std::min(6, length) : 0;
      for (int e = 0; e < unit; ++e) row[e] += pushed[e];
      for (int e = unit; e < length; ++e) row[e] += pushed.dot(motion_->subspace[column[e]]);
    }
    if (node.parent >= 0) stiffen(node.parent, s.stiffness[*i]);
  }
}

void IslandProblem::fillMatrix() {
  const SolverSpace& s = *space_;
  for (const int k : live_dofs_) {
    BlockMatrix::Block h = matrix_.diagonal(s.block[forest_->nodes()[forest_->nodeOfDof(k)].tree]);
    const double* packed = s.hessian.rows.data() + forest_->rowStart(k);
    for (int e = 0; e < forest_->rowLength(k); ++e) h(s.block_row[k], s.block_row[forest_->columns(k)[e]]) += packed[e];
  }
  for (const MimicFold& m : mimics)
    matrix_.fold(s.block[forest_->nodes()[forest_->nodeOfDof(m.dof)].tree], s.block_row[m.dof], s.block_row[m.master], m.multiplier);
}

// Factors the Hessian at the responses at hand. False if it is not positive definite.
bool IslandProblem::factor() {
  SolverSpace& s = *space_;
  factored_ = false;
  if (coupled_ && !laid_) layBlocks();
  const double* base = s.idle.rows.data();
  for (const int k : live_dofs_)
    std::copy(base + forest_->rowStart(k), base + forest_->rowEnd(k), s.hessian.rows.data() + forest_->rowStart(k));
  factored_joints_.clear();
  for (int b = 0; b < live_joint_blocks_; ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const JointBlock& block = joint_blocks_[b];
      factored_joints_.push_back(block.stiffness[lane]);
      if (block.dof[lane] >= 0) s.hessian.rows[forest_->diagonal(block.dof[lane])] += block.stiffness[lane];
    }
  }
  factored_kinds_.clear();
  for (const ContactBlock& b : contact_blocks_) factored_kinds_.insert(factored_kinds_.end(), b.kind, b.kind + LANES);
  addStiffness();
  pushStiffness();
  if (coupled_) {
    fillMatrix();
    return factored_ = matrix_.factor(team_.get());
  }
  for (auto k = live_dofs_.rbegin(); k != live_dofs_.rend(); ++k)
    if (!eliminate(*forest_, *k, &s.hessian)) return false;
  return factored_ = true;
}

// Contacts that slip turn the Hessian a little with every iterate; all else is linear as long as nothing changes its kind.
bool IslandProblem::isFactorCurrent() const {
  if (!factored_) return false;
  const double *kind = factored_kinds_.data(), *stiffness = factored_joints_.data();
  for (const ContactBlock& b : contact_blocks_)
    for (int lane = 0; lane < LANES; ++lane)
      if (b.kind[lane] != *kind++) return false;
  for (int b = 0; b < live_joint_blocks_; ++b)
    for (int lane = 0; lane < LANES; ++lane)
      if (joint_blocks_[b].stiffness[lane] != *stiffness++) return false;
  return true;
}

void IslandProblem::solveBlocks() {
  SolverSpace& s = *space_;
  Eigen::Ref<Eigen::VectorXd> x = block_vector_.head(matrix_.size());
  const auto rowOf = [&](int dof) { return matrix_.offset(s.block[forest_->nodes()[forest_->nodeOfDof(dof)].tree]) + s.block_row[dof]; };
  for (const MimicFold& m : mimics) {
    s.direction[m.master] += m.multiplier * s.direction[m.dof];
    s.direction[m.dof] = 0;
  }
  for (const int k : live_dofs_) x[rowOf(k)] = s.direction[k];
  matrix_.solve(x);
  for (const int k : live_dofs_) s.direction[k] = x[rowOf(k)];
  for (const MimicFold& m : mimics) s.direction[m.dof] = m.multiplier * s.direction[m.master];
}

void IslandProblem::findDirection() {
  SolverSpace& s = *space_;
  for (const int k : live_dofs_) s.direction[k] = -s.gradient[k];
  if (coupled_) return solveBlocks();
  for (const int tree : trees) {
    reduce(*forest_, tree, s.hessian, &s.direction, &s.paths);
    substitute(*forest_, tree, s.hessian, &s.direction, &s.paths);
  }
}

}  // namespace blem_sim::dynamics
