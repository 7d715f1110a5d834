#include "island/island_problem.h"

#include <algorithm>

namespace blem_sim::dynamics {

void SolverSpace::resize(const Forest& forest) {
  for (auto* v : {&free_momentum, &velocity, &mass_velocity, &gradient, &direction, &mass_direction, &scale, &kinetic, &anchor, &idle_pull,
                  &first_velocity, &first_kinetic})
    v->setZero(forest.dofCount());
  idle.resize(forest);
  hessian.resize(forest);
  paths.resize(forest);
  for (auto* v : {&twist, &wrench}) v->resize(forest.nodes().size());
  stiffness.resize(forest.nodes().size());
  for (auto* v : {&stiff, &live}) v->resize(forest.nodes().size());
  block.resize(forest.trees().size());
  block_row.resize(forest.dofCount());
}

void IslandProblem::takeSteps(double a) {
  forContactRanges([a](std::size_t, ContactBlock* first, ContactBlock* end) { take(a, first, end); });
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
    if (!mimics.empty()) multiply(*forest_, tree, motion_->mass, s.velocity, &s.mass_velocity, &s.paths);
    for (int k = t.first_dof; k < t.dof_end; ++k) {
      s.scale[k] = 1 / std::sqrt(motion_->mass[forest_->diagonal(k)]);
      s.kinetic[k] = s.mass_velocity[k] - s.free_momentum[k];
    }
  }
  findLive();
  woken_ = false;
  begin();
}

// Begins the iteration from the velocities at hand, with the live nodes at hand, on the hard problem.
void IslandProblem::begin() {
  factored_ = base_known_ = anchored_ = laid_ = soft_ = false;
  listLive();
  fillBlocks();
  setSteps(space_->velocity);
  takeSteps(1);
  startSlips(contact_blocks_.data(), contact_blocks_.data() + contact_blocks_.size());
  for (LoopTerm& loop : loops) loop.velocity = loop.step;
  soften(1, 1);
}

// Contacts and joints of the terms, four by four; the contacts' velocities begin with the bend of the bodies' paths.
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
}

// Writes the contacts' impulses and velocities back to the terms.
void IslandProblem::readTerms() {
  for (const ContactPatch& p : patches)
    for (int i = p.first; i < p.end; ++i)
      readLane(contact_blocks_[p.first_block + (i - p.first) / LANES], (i - p.first) % LANES, &contacts[i]);
}

// Sets the steps of all contacts, live joints and loops for a change v of the velocities.
void IslandProblem::setSteps(const Eigen::VectorXd& v) {
  for (const int i : live_nodes_) computeTwist(*forest_, i, *motion_, v, &space_->twist);
  forPatches([&](std::size_t index) {
    const ContactPatch& p = patches[index];
    blem_sim::dynamics::setSteps(relativeTwist(p.pair, space_->twist), contact_blocks_.data() + p.first_block,
                                 contact_blocks_.data() + p.block_end);
  });
  for (int b = 0; b < live_joint_blocks_; ++b)
    for (int lane = 0; lane < LANES; ++lane) {
      JointBlock& block = joint_blocks_[b];
      block.step[lane] = block.dof[lane] >= 0 ? v[block.dof[lane]] : 0;
    }
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
  patch_wrenches_.resize(patches.size());
  forPatches([&](std::size_t p) {
    patch_wrenches_[p] = wrenchOf(contact_blocks_.data() + patches[p].first_block, contact_blocks_.data() + patches[p].block_end);
  });
  for (std::size_t p = 0; p < patches.size(); ++p) push(patches[p].pair, patch_wrenches_[p]);
  for (std::size_t l = 0; l < loops.size(); ++l) push(loop_pairs[l], loops[l].basis * loops[l].impulses());
}

// Responses of contacts and live joints at velocity + a step.
PotentialSlope IslandProblem::respond(double a) {
  slopes_.assign(contact_blocks_.size() / BLOCKS_AT_ONCE + 1, PotentialSlope());
  forContactRanges(
      [&](std::size_t range, ContactBlock* first, ContactBlock* end) { slopes_[range] = blem_sim::dynamics::respond(a, first, end); });
  PotentialSlope slope = slopes_[0];
  for (std::size_t range = 1; range < slopes_.size(); ++range) slope += slopes_[range];
  blem_sim::dynamics::respond(a, joint_blocks_.data(), joint_blocks_.data() + live_joint_blocks_, &slope.first, &slope.second);
  responses_at_ = a;
  responses_known_ = a == 0;
  return slope;
}

void IslandProblem::gradient() {
  SolverSpace& s = *space_;
  for (const int k : live_dofs_) s.gradient[k] = s.kinetic[k];
  for (auto i = live_nodes_.rbegin(); i != live_nodes_.rend(); ++i) addProjectedNode(*forest_, *i, *motion_, -1, &s.wrench, &s.gradient);
  for (int b = 0; b < live_joint_blocks_; ++b)
    for (int lane = 0; lane < LANES; ++lane) {
      const JointBlock& block = joint_blocks_[b];
      if (block.dof[lane] >= 0) s.gradient[block.dof[lane]] -= block.impulse[lane];
    }
}

void IslandProblem::foldGradient() {
  for (const MimicFold& m : mimics) {
    space_->gradient[m.master] += m.multiplier * space_->gradient[m.dof];
    space_->gradient[m.dof] = 0;
  }
}

}  // namespace blem_sim::dynamics
