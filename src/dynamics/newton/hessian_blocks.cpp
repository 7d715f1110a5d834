#include "newton/hessian_blocks.h"

#include <algorithm>

namespace blem_sim::dynamics {

int HessianBlocks::placeOfDof(int dof) const {
  const std::vector<int>& trees = island_->model.trees;
  return static_cast<int>(std::lower_bound(trees.begin(), trees.end(), treeOfDof(dof)) - trees.begin());
}

// -1: the first of its tree
int HessianBlocks::parentOf(int dof) const {
  const int length = island_->forest.rowLength(dof);
  return length > 1 ? island_->forest.columns(dof)[length - 2] : -1;
}

void HessianBlocks::lay(const IslandAtHand& island, const std::vector<int>& dofs) {
  island_ = &island;
  dofs_ = &dofs;
  joinTrees();
  findLimbs();
  coupleAll();
  matrix_.analyse();
  if (vector_.size() < matrix_.size()) vector_.resize(matrix_.size());
}

void HessianBlocks::joinTrees() {
  joined_.reset(island_->model.treeCount());
  for (const MimicFold& m : island_->model.mimics) joined_.join(placeOfDof(m.dof), placeOfDof(m.master));
  whole_.assign(joined_.number(), -1);
  sizes_.clear();
  for (const MimicFold& m : island_->model.mimics) {
    int& block = whole_[joined_.islandOf(placeOfDof(m.master))];
    if (block >= 0) continue;
    block = static_cast<int>(sizes_.size());
    sizes_.push_back(0);
  }
}

void HessianBlocks::findLimbs() {
  const std::size_t count = island_->forest.dofCount();
  children_.resize(count);
  block_.resize(count);
  row_.resize(count);
  for (const int k : *dofs_) {
    children_[k] = 0;
    if (parentOf(k) >= 0) ++children_[parentOf(k)];
  }
  for (const int k : *dofs_) {
    const int parent = parentOf(k), whole = whole_[joined_.islandOf(placeOfDof(k))];
    if (whole >= 0) {
      block_[k] = whole;
    } else if (parent >= 0 && children_[parent] == 1) {
      block_[k] = block_[parent];
    } else {
      block_[k] = static_cast<int>(sizes_.size());
      sizes_.push_back(0);
    }
    row_[k] = sizes_[block_[k]]++;
  }
}

// Couples the limbs on the ways from the roots to two dofs.
void HessianBlocks::couplePaths(int dof_a, int dof_b) {
  const Forest& forest = island_->forest;
  for (int e = 0, last_a = -1; e < forest.rowLength(dof_a); ++e) {
    const int a = block_[forest.columns(dof_a)[e]];
    if (a == last_a) continue;
    last_a = a;
    for (int f = 0, last_b = -1; f < forest.rowLength(dof_b); ++f) {
      const int b = block_[forest.columns(dof_b)[f]];
      if (b != last_b && a != b) matrix_.couple(a, b);
      last_b = b;
    }
  }
}

void HessianBlocks::coupleAll() {
  matrix_.start(sizes_);
  for (const int k : *dofs_)
    if (parentOf(k) >= 0 && block_[parentOf(k)] != block_[k]) couplePaths(parentOf(k), k);
  const auto couple = [&](const BodyPair& pair) {
    if (pair.b < 0) return;
    const int a = island_->forest.nodes()[pair.a].last_dof, b = island_->forest.nodes()[pair.b].last_dof;
    if (a >= 0 && b >= 0) couplePaths(a, b);
  };
  for (const PairContacts& p : island_->model.pairs) couple(p.pair);
  for (const BodyPair& pair : island_->model.loop_pairs) couple(pair);
}

// Rows of the first one's limb and columns of the second one's.
HessianBlocks::Cells HessianBlocks::cells(int dof_a, int dof_b) {
  bool transposed = false;
  const int a = block_[dof_a], b = block_[dof_b];
  BlockMatrix::Block block = a == b ? matrix_.diagonal(a) : matrix_.coupling(a, b, &transposed);
  return transposed ? Cells{block.data(), block.rows(), 1} : Cells{block.data(), 1, block.rows()};
}

void HessianBlocks::tie(const BodyPair& pair, const Matrix6& stiffness) {
  const ForestNode &a = island_->forest.nodes()[pair.a], &b = island_->forest.nodes()[pair.b];
  if (a.last_dof < 0 || b.last_dof < 0) return;
  if (a.joint < 0 && b.joint < 0 && a.tree != b.tree)
    tieFree(a, b, stiffness);
  else
    tiePaths(a.last_dof, b.last_dof, stiffness);
}

// Free bodies: their subspaces are the axes.
void HessianBlocks::tieFree(const ForestNode& a, const ForestNode& b, const Matrix6& stiffness) {
  bool transposed = false;
  BlockMatrix::Block block = matrix_.coupling(block_[a.first_dof], block_[b.first_dof], &transposed);
  if (transposed)
    block.block<6, 6>(row_[b.first_dof], row_[a.first_dof]) -= stiffness.transpose();
  else
    block.block<6, 6>(row_[a.first_dof], row_[b.first_dof]) -= stiffness;
}

// A diagonal block keeps its lower triangle only; a dof that carries both nodes gets both halves.
void HessianBlocks::tiePaths(int dof_a, int dof_b, const Matrix6& stiffness) {
  const Forest& forest = island_->forest;
  for (int e = 0; e < forest.rowLength(dof_a); ++e) {
    const int k = forest.columns(dof_a)[e], r = row_[k];
    const Vector6 row = stiffness.transpose() * island_->motion.subspace[k];
    Cells at{};
    for (int f = 0, last = -1; f < forest.rowLength(dof_b); ++f) {
      const int j = forest.columns(dof_b)[f], c = row_[j];
      if (block_[j] != last) at = cells(k, j);
      last = block_[j];
      const double value = row.dot(island_->motion.subspace[j]);
      if (last == block_[k])
        at.at(std::max(r, c), std::min(r, c)) -= k == j ? 2 * value : value;
      else
        at.at(r, c) -= value;
    }
  }
}

void HessianBlocks::add(const std::vector<double>& rows) {
  const Forest& forest = island_->forest;
  for (const int k : *dofs_) {
    const double* packed = rows.data() + forest.rowStart(k);
    Cells at{};
    for (int e = 0, last = -1; e < forest.rowLength(k); ++e) {
      const int j = forest.columns(k)[e];
      if (block_[j] != last) at = cells(k, j);
      last = block_[j];
      at.at(row_[k], row_[j]) += packed[e];
    }
  }
  for (const MimicFold& m : island_->model.mimics) matrix_.fold(block_[m.dof], row_[m.dof], row_[m.master], m.multiplier);
}

void HessianBlocks::solve(Eigen::VectorXd* x) {
  Eigen::Ref<Eigen::VectorXd> by_row = vector_.head(matrix_.size());
  const auto rowOf = [&](int dof) { return matrix_.offset(block_[dof]) + row_[dof]; };
  for (const MimicFold& m : island_->model.mimics) {
    (*x)[m.master] += m.multiplier * (*x)[m.dof];
    (*x)[m.dof] = 0;
  }
  for (const int k : *dofs_) by_row[rowOf(k)] = (*x)[k];
  matrix_.solve(by_row);
  for (const int k : *dofs_) (*x)[k] = by_row[rowOf(k)];
  for (const MimicFold& m : island_->model.mimics) (*x)[m.dof] = m.multiplier * (*x)[m.master];
}

}  // namespace blem_sim::dynamics
