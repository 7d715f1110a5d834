#include "newton/idle_branches.h"

#include <algorithm>
#include <cmath>

#include "problem/island_velocity.h"

namespace blem_sim::dynamics {
namespace {

constexpr int FEW = 8;  // joints that stray: the solution without them is near

}  // namespace

void IdleBranches::start(const IslandAtHand& island, IslandIterate* iterate) {
  island_ = &island;
  iterate_ = iterate;
  have_strayed_ = false;
}

bool IdleBranches::isBaseCurrent() const {
  if (base_ == Base::UNKNOWN) return false;
  bool current = true;
  const double* known = joint_stiffness_.data();
  iterate_->reactions().joints().forIdle([&](const JointBlock& b, int lane, int) { current &= b.stiffness[lane] == *known++; });
  return current;
}

// Rows of idle dofs become those of their factor.
bool IdleBranches::eliminateIdle() {
  const Forest& forest = island_->forest;
  TreeFactor& idle = island_->space->idle;
  base_ = Base::UNKNOWN;
  joint_stiffness_.clear();
  for (const int tree : island_->model.trees) {
    const ForestTree& t = island_->tree(tree);
    if (t.dofCount() == 0) continue;
    const int first = forest.rowStart(t.first_dof), end = forest.rowEnd(t.dof_end - 1);
    std::copy(island_->motion.mass.begin() + first, island_->motion.mass.begin() + end, idle.rows.begin() + first);
  }
  iterate_->reactions().joints().forIdle([&](const JointBlock& b, int lane, int dof) {
    joint_stiffness_.push_back(b.stiffness[lane]);
    idle.rows[forest.diagonal(dof)] += b.stiffness[lane];
  });
  const std::vector<int>& dofs = iterate_->live().idleDofs();
  if (!std::all_of(dofs.rbegin(), dofs.rend(), [&](int k) { return eliminate(forest, k, &idle); })) return false;
  for (const int k : iterate_->live().dofs()) {
    idle.inverse[k] = 0;
    std::fill(idle.rows.begin() + forest.diagonal(k) + 1, idle.rows.begin() + forest.rowEnd(k), 0.0);
  }
  base_ = Base::ELIMINATED;
  return true;
}

void IdleBranches::follow() {
  base_ = Base::FOLLOWED;
  if (iterate_->live().idleDofs().empty()) return;
  SolverSpace& s = *island_->space;
  iterate_->live().forDofs([&s](int k) {
    s.anchor[k] = s.velocity[k];
    s.idle_pull[k] = -s.kinetic[k];
  });
  iterate_->reactions().joints().forIdle([&s](const JointBlock& b, int lane, int dof) { s.idle_pull[dof] += b.impulse[lane]; });
  for (const int tree : island_->model.trees) reduce(island_->forest, tree, s.idle, &s.idle_pull, &s.paths);
  for (const int k : iterate_->live().dofs()) s.kinetic[k] = -s.idle_pull[k];
}

// Directions in which idle dofs have moved since they follow, the live ones having moved as they did.
void IdleBranches::solveIdle() {
  const LiveParts& live = iterate_->live();
  if (live.idleDofs().empty()) return;
  SolverSpace& s = *island_->space;
  for (const int k : live.dofs()) s.direction[k] = s.velocity[k] - s.anchor[k];
  for (const int k : live.idleDofs()) s.direction[k] = s.idle_pull[k];
  for (const int tree : island_->model.trees) substitute(island_->forest, tree, s.idle, &s.direction, &s.paths);
}

// Velocities of idle dofs at the present iterate. @return [sqrt(kg) m/s] difference of their joints' impulses from those extended linearly
double IdleBranches::findVelocities() {
  SolverSpace& s = *island_->space;
  const std::vector<int>& idle = iterate_->live().idleDofs();
  solveIdle();
  for (const int k : idle) {
    s.velocity[k] = s.anchor[k] + s.direction[k];
    s.kinetic[k] = s.gradient[k] = 0;
  }
  iterate_->reactions().joints().forIdle(
      [&s](const JointBlock& b, int lane, int dof) { s.kinetic[dof] = b.impulse[lane] - b.stiffness[lane] * s.direction[dof]; });
  iterate_->reactions().respondIdle();
  iterate_->reactions().joints().forIdle(
      [&s](const JointBlock& b, int lane, int dof) { s.gradient[dof] = s.kinetic[dof] - b.impulse[lane]; });
  iterate_->live().forDofs([&s](int k) { s.mass_velocity[k] = s.free_momentum[k] + s.kinetic[k]; });
  return gradientNorm(*island_, idle);
}

IdleBranches::Outcome IdleBranches::settle(double enough, double* missed) {
  *missed = findVelocities();
  if (!(*missed <= enough)) return wakeStrays(enough);
  base_ = Base::ELIMINATED;
  return Outcome::FOLLOWED;
}

IdleBranches::Outcome IdleBranches::wakeStrays(double enough) {
  const SolverSpace& s = *island_->space;
  const std::vector<int>& idle = iterate_->live().idleDofs();
  const auto strays = [&](int dof) { return std::abs(s.gradient[dof]) * s.scale[dof] > enough; };
  const bool all = have_strayed_ || std::count_if(idle.begin(), idle.end(), strays) > FEW;
  for (const int k : idle)
    if (all || strays(k)) iterate_->live().wake(k);
  have_strayed_ = true;
  forget();
  return all ? Outcome::STRAYED : Outcome::FEW_STRAYED;
}

}  // namespace blem_sim::dynamics
