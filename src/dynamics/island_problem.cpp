#include "island_problem.h"

#include <algorithm>

namespace blem_sim {
namespace {

Vector6 relativeTwist(const BodyPair& pair, const std::vector<Vector6>& twist) {
  if (pair.b < 0) return twist[pair.a];
  return twist[pair.a] - moveTwist(twist[pair.b], -pair.shift);
}

/** Adds the 6 x 6 by which a spring along one direction at a point is felt. */
void addSpring(const Vector3& point, const Vector3& direction, double gain, Matrix6* out) {
  const Vector6 wrench = wrenchOf(direction, point), scaled = gain * wrench;
  out->noalias() += scaled * wrench.transpose();
}

/** Adds J' k J for a point, k being the response's stiffness: the 6 x 6 by which the contact is felt. */
void addPointStiffness(const Vector3& point, const ConeResponse& response, Matrix6* out) {
  if (response.kind == ConeResponse::Kind::SLIP) {
    addSpring(point, response.axis, response.normal_gain, out);
    addSpring(point, response.side, response.tangent_gain, out);
    return;
  }
  const double gain = response.tangent_gain;
  const Matrix3 turned = gain * crossMatrix(point);
  out->topLeftCorner<3, 3>() -= gain * point * point.transpose();
  out->topRightCorner<3, 3>() += turned;
  out->bottomLeftCorner<3, 3>() -= turned;
  out->diagonal().head<3>().array() += gain * point.squaredNorm();
  out->diagonal().tail<3>().array() += gain;
  addSpring(point, response.axis, response.normal_gain - gain, out);
}

/** Twists about b's reference point to those about a's. */
Matrix6 shiftMatrix(const Vector3& shift) {
  Matrix6 x = Matrix6::Identity();
  x.bottomLeftCorner<3, 3>() = crossMatrix(shift);
  return x;
}

}  // namespace

void SolverSpace::resize(const Forest& forest) {
  for (auto* v : {&free_momentum, &velocity, &mass_velocity, &gradient, &direction, &mass_direction, &scale}) v->setZero(forest.dofCount());
  hessian.resize(forest.entryCount());
  for (auto* v : {&twist, &wrench}) v->resize(forest.nodes().size());
  stiffness.resize(forest.nodes().size());
  stiff.resize(forest.nodes().size());
  block.resize(forest.trees().size());
  block_row.resize(forest.dofCount());
}

void IslandProblem::clear() {
  trees.clear();
  joints.clear();
  patches.clear();
  contacts.clear();
  loops.clear();
  loop_pairs.clear();
  mimics.clear();
}

void IslandProblem::start() {
  SolverSpace& s = *space_;
  for (const MimicFold& m : mimics) s.velocity[m.dof] = m.multiplier * s.velocity[m.master];
  coupled_ = !mimics.empty() || !loops.empty();
  for (const ContactPatch& p : patches) coupled_ |= p.pair.b >= 0;
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    for (int k = t.first_dof; k < t.dof_end; ++k)
      s.scale[k] = 1 / std::sqrt(motion_->mass[forest_->rowStart(k) + forest_->rowLength(k) - 1]);
    massTimes(*forest_, tree, *motion_, s.velocity, &s.mass_velocity);
  }
  if (coupled_) layBlocks();
  relativeSteps(s.velocity, true);
}

void IslandProblem::layBlocks() {
  SolverSpace& s = *space_;
  const auto treeOf = [&](int node) { return forest_->nodes()[node].tree; };
  const auto placeOf = [&](int tree) { return static_cast<int>(std::lower_bound(trees.begin(), trees.end(), tree) - trees.begin()); };
  tree_blocks_.reset(static_cast<int>(trees.size()));
  for (const MimicFold& m : mimics)
    tree_blocks_.join(placeOf(treeOf(forest_->nodeOfDof(m.dof))), placeOf(treeOf(forest_->nodeOfDof(m.master))));
  block_sizes_.assign(tree_blocks_.number(), 0);
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const ForestTree& t = forest_->trees()[trees[i]];
    const int block = s.block[trees[i]] = tree_blocks_.islandOf(static_cast<int>(i));
    for (int k = t.first_dof; k < t.dof_end; ++k) s.block_row[k] = block_sizes_[block]++;
  }
  matrix_.start(block_sizes_);
  const auto couple = [&](const BodyPair& pair) {
    if (pair.b < 0) return;
    const int a = s.block[treeOf(pair.a)], b = s.block[treeOf(pair.b)];
    if (a != b) matrix_.couple(a, b);
  };
  for (const ContactPatch& p : patches) couple(p.pair);
  for (const BodyPair& pair : loop_pairs) couple(pair);
  matrix_.analyse();
  if (block_vector_.size() < matrix_.size()) block_vector_.resize(matrix_.size());
}

// Relative velocities of all contacts and loops for velocities v, kept as `velocity` or as `step`.
void IslandProblem::relativeSteps(const Eigen::VectorXd& v, bool as_velocity) {
  for (const int tree : trees) computeTwists(*forest_, tree, *motion_, v, &space_->twist);
  for (const ContactPatch& p : patches) {
    const Vector6 relative = relativeTwist(p.pair, space_->twist);
    for (int i = p.first; i < p.end; ++i) {
      ContactTerm& c = contacts[i];
      const Vector3 u = velocityAt(relative, c.point);
      (as_velocity ? c.velocity : c.step) = as_velocity ? Vector3(u + c.bend) : u;
    }
  }
  for (std::size_t l = 0; l < loops.size(); ++l)
    (as_velocity ? loops[l].velocity : loops[l].step) = loops[l].basis.transpose() * relativeTwist(loop_pairs[l], space_->twist);
}

void IslandProblem::stiffen(int node, const Matrix6& stiffness) {
  SolverSpace& s = *space_;
  if (s.stiff[node])
    s.stiffness[node] += stiffness;
  else
    s.stiffness[node] = stiffness;
  s.stiff[node] = 1;
}

void IslandProblem::push(const BodyPair& pair, const Vector6& wrench, const Matrix6* stiffness) {
  SolverSpace& s = *space_;
  s.wrench[pair.a] += wrench;
  if (stiffness) stiffen(pair.a, *stiffness);
  if (pair.b < 0) return;
  s.wrench[pair.b] -= moveWrench(wrench, -pair.shift);
  if (!stiffness) return;
  const Matrix6 x = shiftMatrix(pair.shift);
  stiffen(pair.b, x.transpose() * *stiffness * x);
  coupleBlocks(pair, *stiffness * x);
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
      // Of a diagonal block only the lower triangle is kept; a dof that carries both gets both halves.
      if (block_a == block_b)
        block(std::max(r, c), std::min(r, c)) -= r == c ? 2 * value : value;
      else
        (transposed ? block(c, r) : block(r, c)) -= value;
    }
  }
}

void IslandProblem::evaluatePatch(const ContactPatch& patch) {
  Vector6 wrench = Vector6::Zero();
  Matrix6 stiffness = Matrix6::Zero();
  bool stiff = false;
  for (int i = patch.first; i < patch.end; ++i) {
    ContactTerm& c = contacts[i];
    const ConeResponse response = responses_known_ ? responses_[i] : c.respond(c.velocity);
    c.impulse = response.impulse;
    if (response.kind == ConeResponse::Kind::OPEN) continue;
    wrench += wrenchOf(c.impulse, c.point);
    addPointStiffness(c.point, response, &stiffness);
    stiff = true;
  }
  push(patch.pair, wrench, stiff ? &stiffness : nullptr);
}

void IslandProblem::evaluateLoop(std::size_t index) {
  const LoopTerm& loop = loops[index];
  Vector6 gain;
  for (int r = 0; r < 6; ++r) gain[r] = loop.stiffness(r, loop.velocity[r]);
  const Matrix6 stiffness = loop.basis * gain.asDiagonal() * loop.basis.transpose();
  push(loop_pairs[index], loop.basis * loop.impulses(), &stiffness);
}

// Impulses at the present iterate, as wrenches on the nodes, and how they stiffen the bodies.
void IslandProblem::evaluate() {
  SolverSpace& s = *space_;
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    for (int i = t.first_node; i < t.node_end; ++i) {
      s.wrench[i].setZero();
      s.stiff[i] = 0;
    }
  }
  if (coupled_) matrix_.setZero();
  for (const ContactPatch& p : patches) evaluatePatch(p);
  for (std::size_t l = 0; l < loops.size(); ++l) evaluateLoop(l);
  responses_known_ = false;
}

void IslandProblem::gradient() {
  SolverSpace& s = *space_;
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    for (int k = t.first_dof; k < t.dof_end; ++k) s.gradient[k] = s.mass_velocity[k] - s.free_momentum[k];
    addProjected(*forest_, tree, *motion_, -1, &s.wrench, &s.gradient);
  }
  for (const JointTerm& j : joints) s.gradient[j.dof] -= j.impulse(s.velocity[j.dof]);
}

// M plus the bodies' stiffnesses, which are pushed to the root like inertias: the sparsity stays that of M.
void IslandProblem::treeHessian(int tree) {
  SolverSpace& s = *space_;
  const ForestTree& t = forest_->trees()[tree];
  if (t.dofCount() == 0) return;
  const int begin = forest_->rowStart(t.first_dof), end = forest_->rowStart(t.dof_end - 1) + forest_->rowLength(t.dof_end - 1);
  std::copy(motion_->mass.begin() + begin, motion_->mass.begin() + end, s.hessian.begin() + begin);
  for (int i = t.node_end - 1; i >= t.first_node; --i) {
    if (!s.stiff[i]) continue;
    const ForestNode& node = forest_->nodes()[i];
    for (int d = 0; d < node.dofs; ++d) {
      const int k = node.first_dof + d, length = forest_->rowLength(k);
      const int* column = forest_->columns(k);
      double* row = s.hessian.data() + forest_->rowStart(k);
      const Vector6 pushed = s.stiffness[i] * motion_->subspace[k];
      const int unit = t.free ? std::min(6, length) : 0;
      for (int e = 0; e < unit; ++e) row[e] += pushed[e];
      for (int e = unit; e < length; ++e) row[e] += pushed.dot(motion_->subspace[column[e]]);
    }
    if (node.parent >= 0) stiffen(node.parent, s.stiffness[i]);
  }
}

}  // namespace blem_sim
