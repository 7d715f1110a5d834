// Idle branches: branches of trees that nothing touches are not iterated, but follow the others, as long as their joints answer linearly.
#include <algorithm>

#include "island/island_problem.h"

namespace blem_sim::dynamics {
namespace {

constexpr int FEW = 8;  // joints that stray: the solution without them is near

}  // namespace

// Finds the live nodes: those that something acts on, and those that carry them.
void IslandProblem::findLive() {
  SolverSpace& s = *space_;
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    std::fill(s.live.begin() + t.first_node, s.live.begin() + t.node_end, 0);
  }
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
}

void IslandProblem::wake(int node) {
  std::vector<char>& live = space_->live;
  for (; node >= 0 && !live[node]; node = forest_->nodes()[node].parent) live[node] = 1;
}

void IslandProblem::listLive() {
  live_nodes_.clear();
  live_dofs_.clear();
  idle_dofs_.clear();
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    for (int i = t.first_node; i < t.node_end; ++i) {
      const ForestNode& node = forest_->nodes()[i];
      const bool live = space_->live[i];
      if (live) live_nodes_.push_back(i);
      for (int d = 0; d < node.dofs; ++d) (live ? live_dofs_ : idle_dofs_).push_back(node.first_dof + d);
    }
  }
  for (const int k : idle_dofs_) space_->hessian.inverse[k] = 0;
  orderJoints();
}

// Orders the joints: live ones first, in blocks of their own.
void IslandProblem::orderJoints() {
  joint_order_.clear();
  const auto add = [&](bool idle) {
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (isIdle(joints[j].dof) == idle) joint_order_.push_back(static_cast<int>(j));
    while (joint_order_.size() % LANES != 0) joint_order_.push_back(-1);
  };
  joint_order_.reserve(joints.size() + 2 * LANES);
  joint_blocks_.reserve(joints.size() / LANES + 2);
  add(false);
  live_joint_blocks_ = static_cast<int>(joint_order_.size()) / LANES;
  add(true);
  joint_blocks_.resize(joint_order_.size() / LANES);
  for (std::size_t lane = 0; lane < joint_order_.size(); ++lane) {
    const int term = joint_order_[lane];
    joint_blocks_[lane / LANES].velocity[lane % LANES] = term < 0 ? 0 : space_->velocity[joints[term].dof];
  }
}

const JointTerm* IslandProblem::termOf(int block, int lane) const {
  const int term = joint_order_[block * LANES + lane];
  return term < 0 ? nullptr : &joints[term];
}

void IslandProblem::setJoints() {
  for (std::size_t b = 0; b < joint_blocks_.size(); ++b)
    for (int lane = 0; lane < LANES; ++lane) setLane(termOf(static_cast<int>(b), lane), lane, &joint_blocks_[b]);
}

void IslandProblem::softenJoints() {
  for (JointTerm& j : joints) j.softness = isIdle(j.dof) ? 1 : joint_softness_;
  setJoints();
}

bool IslandProblem::isIdle(int dof) const { return !space_->live[forest_->nodeOfDof(dof)]; }

// Responses of idle joints at the velocities at hand.
void IslandProblem::respondIdle() {
  double first = 0, second = 0;
  blem_sim::dynamics::respond(0, joint_blocks_.data() + live_joint_blocks_, joint_blocks_.data() + joint_blocks_.size(), &first, &second);
}

// Whether the velocities at hand solve the problem. Idle dofs first: they cost least.
bool IslandProblem::isSolved(double tolerance) {
  SolverSpace& s = *space_;
  respondIdle();
  for (const int k : idle_dofs_) s.gradient[k] = s.kinetic[k];
  forIdleJoints([&](JointBlock* b, int lane, int dof) { s.gradient[dof] -= b->impulse[lane]; });
  gradient_norm_ = gradientNorm(idle_dofs_);
  if (gradient_norm_ > tolerance) return false;
  evaluateGradient();
  gradient_norm_ = std::max(gradient_norm_, gradientNorm(live_dofs_));
  return gradient_norm_ <= tolerance;
}

bool IslandProblem::isBaseCurrent() {
  if (!base_known_) return false;
  bool current = true;
  const double* known = base_joints_.data();
  forIdleJoints([&](JointBlock* b, int lane, int) { current &= b->stiffness[lane] == *known++; });
  return current;
}

// Eliminates idle dofs: their rows become those of the factor; those of live dofs hold the rest of M.
bool IslandProblem::eliminateIdle() {
  SolverSpace& s = *space_;
  base_joints_.clear();
  factored_ = false;
  for (const int tree : trees) {
    const ForestTree& t = forest_->trees()[tree];
    if (t.dofCount() == 0) continue;
    const int first = forest_->rowStart(t.first_dof), end = forest_->rowEnd(t.dof_end - 1);
    std::copy(motion_->mass.begin() + first, motion_->mass.begin() + end, s.idle.rows.begin() + first);
  }
  forIdleJoints([&](JointBlock* b, int lane, int dof) {
    base_joints_.push_back(b->stiffness[lane]);
    s.idle.rows[forest_->diagonal(dof)] += b->stiffness[lane];
  });
  for (auto k = idle_dofs_.rbegin(); k != idle_dofs_.rend(); ++k)
    if (!eliminate(*forest_, *k, &s.idle)) return false;
  for (const int k : live_dofs_) {
    s.idle.inverse[k] = 0;
    std::fill(s.idle.rows.begin() + forest_->diagonal(k) + 1, s.idle.rows.begin() + forest_->rowEnd(k), 0.0);
  }
  return base_known_ = true;
}

// Makes idle dofs follow from the velocities at hand: their joints' responses at hand are extended linearly.
bool IslandProblem::anchor() {
  SolverSpace& s = *space_;
  gradient_norm_ = INFINITY;
  if (!isBaseCurrent() && !eliminateIdle()) return false;
  anchored_ = true;
  if (idle_dofs_.empty()) return true;
  forDofs([&](int k) {
    s.anchor[k] = s.velocity[k];
    s.idle_pull[k] = -s.kinetic[k];
  });
  forIdleJoints([&](JointBlock* b, int lane, int dof) { s.idle_pull[dof] += b->impulse[lane]; });
  for (const int tree : trees) reduce(*forest_, tree, s.idle, &s.idle_pull, &s.paths);
  for (const int k : live_dofs_) s.kinetic[k] = -s.idle_pull[k];
  return true;
}

// Velocities of idle dofs at the present iterate. @return [sqrt(kg) m/s] difference of their joints' impulses from those extended linearly
double IslandProblem::followIdle() {
  SolverSpace& s = *space_;
  anchored_ = false;
  if (!idle_dofs_.empty()) {
    for (const int k : live_dofs_) s.direction[k] = s.velocity[k] - s.anchor[k];
    for (const int k : idle_dofs_) s.direction[k] = s.idle_pull[k];
    for (const int tree : trees) substitute(*forest_, tree, s.idle, &s.direction, &s.paths);
  }
  for (const int k : idle_dofs_) {
    s.velocity[k] = s.anchor[k] + s.direction[k];
    s.kinetic[k] = s.gradient[k] = 0;
  }
  forIdleJoints([&](JointBlock* b, int lane, int dof) {
    s.kinetic[dof] = b->impulse[lane] - b->stiffness[lane] * s.direction[dof];
    b->velocity[lane] = s.velocity[dof];
  });
  respondIdle();
  forIdleJoints([&](JointBlock* b, int lane, int dof) { s.gradient[dof] = s.kinetic[dof] - b->impulse[lane]; });
  forDofs([&](int k) { s.mass_velocity[k] = s.free_momentum[k] + s.kinetic[k]; });
  return gradientNorm(idle_dofs_);
}

// Finds the velocities of idle dofs. False if joints have left the piece of their response that they were on. These joints are live from
// then on if they are few; or else, or if it happens again, all are.
bool IslandProblem::settle(double enough) {
  const double missed = followIdle();
  gradient_norm_ = std::max(gradient_norm_, missed);
  if (missed <= enough) return true;
  const SolverSpace& s = *space_;
  const auto strays = [&](int dof) { return std::abs(s.gradient[dof]) * s.scale[dof] > enough; };
  strayed_ = woken_ || std::count_if(idle_dofs_.begin(), idle_dofs_.end(), strays) > FEW;
  for (const int k : idle_dofs_)
    if (strayed_ || strays(k)) wake(forest_->nodeOfDof(k));
  woken_ = true;
  base_known_ = factored_ = responses_known_ = laid_ = false;
  listLive();
  softenJoints();
  return false;
}

void IslandProblem::keepFirst() {
  SolverSpace& s = *space_;
  forDofs([&s](int k) {
    s.first_velocity[k] = s.velocity[k];
    s.first_kinetic[k] = s.kinetic[k];
  });
}

// Back to the first velocities of the iteration: idle joints that left their pieces have led to no place to go on from.
void IslandProblem::rewind() {
  SolverSpace& s = *space_;
  forDofs([&s](int k) {
    s.velocity[k] = s.first_velocity[k];
    s.kinetic[k] = s.first_kinetic[k];
  });
  begin();
}

}  // namespace blem_sim::dynamics
