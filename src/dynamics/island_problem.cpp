#include "island_problem.h"

#include <algorithm>

namespace blem_sim {
namespace {

Vector6 relativeTwist(const BodyPair& pair, const std::vector<Vector6>& twist) {
  if (pair.b < 0) return twist[pair.a];
  return twist[pair.a] - moveTwist(twist[pair.b], -pair.shift);
}

}  // namespace

void SolverSpace::resize(const Forest& forest) {
  for (auto* v : {&free_momentum, &velocity, &mass_velocity, &gradient, &direction, &mass_direction, &scale}) v->setZero(forest.dofCount());
  hessian.resize(forest);
  base.assign(forest.entryCount(), 0);
  paths.resize(forest);
  for (auto* v : {&twist, &wrench}) v->resize(forest.nodes().size());
  stiffness.resize(forest.nodes().size());
  for (auto* v : {&stiff, &live}) v->resize(forest.nodes().size());
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
    for (int k = t.first_dof; k < t.dof_end; ++k) s.scale[k] = 1 / std::sqrt(motion_->mass[forest_->diagonal(k)]);
    multiply(*forest_, tree, motion_->mass, s.velocity, &s.mass_velocity, &s.paths);
  }
  findLive();
  factored_ = base_known_ = false;
  if (coupled_) layBlocks();
  fillBlocks();
  setSteps(s.velocity);
  take(1, contact_blocks_.data(), contact_blocks_.data() + contact_blocks_.size());
  for (JointBlock& b : joint_blocks_) std::copy_n(b.step, LANES, b.velocity);
  for (LoopTerm& loop : loops) loop.velocity = loop.step;
}

// Contacts and joints of the terms, four by four; the contacts' velocities begin with what the bodies' paths bend apart.
void IslandProblem::fillBlocks() {
  contact_blocks_.clear();
  for (ContactPatch& p : patches) {
    p.first_block = static_cast<int>(contact_blocks_.size());
    for (int first = p.first; first < p.end; first += LANES) {
      contact_blocks_.emplace_back();
      for (int lane = 0; lane < LANES; ++lane)
        setLane(first + lane < p.end ? &contacts[first + lane] : nullptr, lane, &contact_blocks_.back());
    }
    p.block_end = static_cast<int>(contact_blocks_.size());
  }
  joint_blocks_.resize((joints.size() + LANES - 1) / LANES);
  setJoints();
}

// What was found, back to the terms.
void IslandProblem::readTerms() {
  for (const ContactPatch& p : patches)
    for (int i = p.first; i < p.end; ++i)
      readLane(contact_blocks_[p.first_block + (i - p.first) / LANES], (i - p.first) % LANES, &contacts[i]);
}

// Nodes that something acts on, and those that carry them: what the others take from the Hessian does not change from iterate to iterate.
void IslandProblem::findLive() {
  SolverSpace& s = *space_;
  live_nodes_.clear();
  live_dofs_.clear();
  idle_dofs_.clear();
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    std::fill(s.live.begin() + t.first_node, s.live.begin() + t.node_end, 0);
  }
  const auto wake = [&](int node) {
    for (; node >= 0 && !s.live[node]; node = forest_->nodes()[node].parent) s.live[node] = 1;
  };
  for (const ContactPatch& p : patches) {
    wake(p.pair.a);
    wake(p.pair.b);
  }
  for (const BodyPair& pair : loop_pairs) {
    wake(pair.a);
    wake(pair.b);
  }
  for (const MimicFold& m : mimics) {
    wake(forest_->nodeOfDof(m.dof));
    wake(forest_->nodeOfDof(m.master));
  }
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    for (int i = t.first_node; i < t.node_end; ++i) {
      const ForestNode& node = forest_->nodes()[i];
      if (s.live[i]) live_nodes_.push_back(i);
      for (int d = 0; d < node.dofs; ++d) (s.live[i] ? live_dofs_ : idle_dofs_).push_back(node.first_dof + d);
    }
  }
}

// Of all contacts, joints and loops, for a change v of the velocities.
void IslandProblem::setSteps(const Eigen::VectorXd& v) {
  for (const int i : live_nodes_) computeTwist(*forest_, i, *motion_, v, &space_->twist);
  for (const ContactPatch& p : patches)
    blem_sim::setSteps(relativeTwist(p.pair, space_->twist), contact_blocks_.data() + p.first_block, contact_blocks_.data() + p.block_end);
  for (JointBlock& b : joint_blocks_)
    for (int lane = 0; lane < LANES; ++lane) b.step[lane] = b.dof[lane] >= 0 ? v[b.dof[lane]] : 0;
  for (std::size_t l = 0; l < loops.size(); ++l) loops[l].step = loops[l].basis.transpose() * relativeTwist(loop_pairs[l], space_->twist);
}

void IslandProblem::push(const BodyPair& pair, const Vector6& wrench) {
  space_->wrench[pair.a] += wrench;
  if (pair.b >= 0) space_->wrench[pair.b] -= moveWrench(wrench, -pair.shift);
}

// Impulses at the present iterate, as wrenches on the nodes.
void IslandProblem::evaluate() {
  SolverSpace& s = *space_;
  if (!responses_known_) respond(0);
  for (const int i : live_nodes_) s.wrench[i].setZero();
  for (const ContactPatch& p : patches)
    push(p.pair, wrenchOf(contact_blocks_.data() + p.first_block, contact_blocks_.data() + p.block_end));
  for (std::size_t l = 0; l < loops.size(); ++l) push(loop_pairs[l], loops[l].basis * loops[l].impulses());
}

// Of contacts and joints, at velocity + a step.
PotentialSlope IslandProblem::respond(double a) {
  PotentialSlope slope = blem_sim::respond(a, contact_blocks_.data(), contact_blocks_.data() + contact_blocks_.size());
  blem_sim::respond(a, joint_blocks_.data(), joint_blocks_.data() + joint_blocks_.size(), &slope.first, &slope.second);
  responses_at_ = a;
  responses_known_ = a == 0;
  return slope;
}

void IslandProblem::gradient() {
  SolverSpace& s = *space_;
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    s.gradient.segment(t.first_dof, t.dofCount()) =
        s.mass_velocity.segment(t.first_dof, t.dofCount()) - s.free_momentum.segment(t.first_dof, t.dofCount());
  }
  for (auto i = live_nodes_.rbegin(); i != live_nodes_.rend(); ++i) addProjectedNode(*forest_, *i, *motion_, -1, &s.wrench, &s.gradient);
  for (const JointBlock& b : joint_blocks_)
    for (int lane = 0; lane < LANES; ++lane)
      if (b.dof[lane] >= 0) s.gradient[b.dof[lane]] -= b.impulse[lane];
}

void IslandProblem::foldGradient() {
  for (const MimicFold& m : mimics) {
    space_->gradient[m.master] += m.multiplier * space_->gradient[m.dof];
    space_->gradient[m.dof] = 0;
  }
}

}  // namespace blem_sim
