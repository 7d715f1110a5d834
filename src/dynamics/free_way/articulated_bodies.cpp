#include "free_way/articulated_bodies.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "lanes/lanes.h"

namespace blem_sim::dynamics {
namespace {

Matrix6 matrixOf(const SpatialInertia& inertia) {
  Matrix6 m;
  const Matrix3 moment = crossMatrix(inertia.first_moment);
  m << inertia.rotational, moment, -moment, inertia.mass * Matrix3::Identity();
  return m;
}

}  // namespace

void ArticulatedBodies::resize(const Forest& forest) {
  const std::size_t nodes = forest.nodes().size(), dofs = forest.dofCount();
  articulated_.resize(nodes);
  for (auto* v : {&bias_, &pull_, &node_acceleration_}) v->resize(nodes);
  for (auto* v : {&lack_, &inverse_}) v->assign(dofs, 0);
  for (auto* v : {&acceleration_, &effort_}) v->setZero(dofs);
  held.assign(dofs, 0);
  ties_.assign(forest.trees().size(), TreeTies());
  for (const MimicRelation& m : forest.mimics()) {
    const ForestNode &node = forest.nodes()[m.node], &master = forest.nodes()[m.master];
    if (node.tree == master.tree) ties_[node.tree].all.push_back({node.first_dof, master.first_dof, m.multiplier});
  }
  for (TreeTies& ties : ties_) {
    const auto count = static_cast<Eigen::Index>(ties.all.size());
    ties.kept.reserve(ties.all.size());
    ties.strays.setZero(count, count);
    ties.wanted.setZero(count);
  }
}

void ArticulatedBodies::start(const Forest& forest, int tree) {
  TreeTies& ties = ties_[tree];
  ties.kept.clear();
  for (const Tie& tie : ties.all)
    if (!held[tie.dof] && !held[tie.master]) ties.kept.push_back(tie);
  const ForestTree& t = forest.trees()[tree];
  effort_.segment(t.first_dof, t.dofCount()).setZero();
}

// Articulated inertia of all that a node carries, about the tree's reference; added to its parent's.
void ArticulatedBodies::articulate(const Forest& forest, int node, const ForestMotion& at) {
  const ForestNode& n = forest.nodes()[node];
  if (n.joint < 0) return;
  const Matrix6& inertia = articulated_[node];
  const bool turns = this->turns(n);
  if (turns) {
    const Vector6& s = at.subspace[n.first_dof];
    pull_[node].noalias() = inertia * s;
    inverse_[n.first_dof] = 1 / (s.dot(pull_[node]) + n.armature);
  }
  if (n.parent < 0) return;
  articulated_[n.parent] += inertia;
  if (!turns) return;
  const Vector6 scaled = inverse_[n.first_dof] * pull_[node];
  articulated_[n.parent].noalias() -= pull_[node] * scaled.transpose();
}

// Bias of all that a node carries, likewise.
void ArticulatedBodies::collect(const Forest& forest, int node, const ForestMotion& at) {
  const ForestNode& n = forest.nodes()[node];
  if (n.joint < 0) return;
  const Vector6& bias = bias_[node];
  const int k = n.first_dof;
  const bool turns = this->turns(n);
  if (turns) lack_[k] = effort_[k] - at.subspace[k].dot(bias);
  if (n.parent < 0) return;
  Vector6& up = bias_[n.parent];
  up += bias;
  up.noalias() += articulated_[node] * at.drift[node];
  if (turns) up += pull_[node] * (inverse_[k] * (lack_[k] - pull_[node].dot(at.drift[node])));
}

BLEM_SIM_LANES void ArticulatedBodies::articulateAll(const Forest& forest, int tree, const ForestMotion& at) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) articulated_[i] = matrixOf(at.inertia[i]);
  for (int i = t.node_end - 1; i >= t.first_node; --i) articulate(forest, i, at);
}

// Accelerations by the efforts at hand. @param moves with the velocities at the instant; else from rest
BLEM_SIM_LANES void ArticulatedBodies::solve(const Forest& forest, int tree, bool moves, ForestMotion* at) {
  const ForestTree& t = forest.trees()[tree];
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& n = forest.nodes()[i];
    at->drift[i].setZero();
    bias_[i].setZero();
    if (!moves) continue;
    bias_[i] = crossForce(at->twist[i], at->inertia[i].times(at->twist[i]));
    if (n.dofs == 1 && n.parent >= 0)
      at->drift[i] = crossMotion(at->twist[n.parent], at->subspace[n.first_dof] * at->velocity[n.first_dof]);
  }
  for (int i = t.node_end - 1; i >= t.first_node; --i) collect(forest, i, *at);
  for (int i = t.first_node; i < t.node_end; ++i) {
    const ForestNode& n = forest.nodes()[i];
    Vector6& a = node_acceleration_[i];
    if (n.joint < 0) {
      a = -articulated_[i].llt().solve(bias_[i]);
      acceleration_.segment<6>(n.first_dof) = a;
      continue;
    }
    a = at->drift[i];
    if (n.parent >= 0) a += node_acceleration_[n.parent];
    if (n.dofs == 0) continue;
    const int k = n.first_dof;
    if (held[k]) {
      acceleration_[k] = 0;
      effort_[k] = at->subspace[k].dot(articulated_[i] * a + bias_[i]);
    } else {
      acceleration_[k] = inverse_[k] * (lack_[k] - pull_[i].dot(a));
      a += at->subspace[k] * acceleration_[k];
    }
  }
}

void ArticulatedBodies::relax(int tree) {
  for (const Tie& tie : ties_[tree].kept) effort_[tie.dof] = effort_[tie.master] = 0;
}

void ArticulatedBodies::addEffort(const Tie& tie, double effort) {
  effort_[tie.dof] += effort;
  effort_[tie.master] -= tie.multiplier * effort;
}

// Efforts by which ties keep their relations: accelerations answer linearly.
void ArticulatedBodies::findEfforts(const Forest& forest, int tree, ForestMotion* at) {
  const std::vector<Tie>& ties = ties_[tree].kept;
  const auto count = static_cast<Eigen::Index>(ties.size());
  Eigen::Ref<Eigen::MatrixXd> strays = ties_[tree].strays.topLeftCorner(count, count);
  Eigen::Ref<Eigen::VectorXd> wanted = ties_[tree].wanted.head(count);
  const auto stray = [this](const Tie& tie) { return acceleration_[tie.dof] - tie.multiplier * acceleration_[tie.master]; };
  for (Eigen::Index i = 0; i < count; ++i) wanted[i] = -stray(ties[i]);
  for (Eigen::Index by = 0; by < count; ++by) {
    addEffort(ties[by], 1);
    solve(forest, tree, false, at);
    for (Eigen::Index i = 0; i < count; ++i) strays(i, by) = stray(ties[i]);
    relax(tree);
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(strays);
  factor.solveInPlace(wanted);
  for (Eigen::Index i = 0; i < count; ++i) addEffort(ties[i], wanted[i]);
}

void ArticulatedBodies::accelerate(const Forest& forest, int tree, ForestMotion* at) {
  articulateAll(forest, tree, *at);
  relax(tree);
  solve(forest, tree, true, at);
  if (ties_[tree].kept.empty()) return;
  findEfforts(forest, tree, at);
  solve(forest, tree, true, at);
}

}  // namespace blem_sim::dynamics
