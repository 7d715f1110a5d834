#include "iterate/island_iterate.h"

#include <algorithm>
#include <cmath>

#include "problem/island_velocity.h"

namespace blem_sim::dynamics {

void IslandIterate::start(const IslandAtHand& island) {
  island_ = &island;
  SolverSpace& s = *island.space;
  const std::vector<MimicFold>& mimics = island.model.mimics;
  for (const MimicFold& m : mimics) s.velocity[m.dof] = m.multiplier * s.velocity[m.master];
  if (!mimics.empty()) multiplyMass(island, s.velocity, &s.mass_velocity);
  setScale(island);
  setKinetic(island);
  live_.find(island);
  begin();
  first_speed_ = reactions_.contacts().fastest();
}

void IslandIterate::begin() {
  live_.list();
  reactions_.begin(*island_, live_);
}

void IslandIterate::takeWoken() {
  live_.list();
  reactions_.orderJoints();
}

// Gradient by the impulses at the present iterate, each dof by itself.
void IslandIterate::gradient() {
  reactions_.sumWrenches();
  SolverSpace& s = *island_->space;
  for (const int k : live_.dofs()) s.gradient[k] = s.kinetic[k];
  const WrenchProjection against{island_->forest, island_->motion, -1, &s.wrench, &s.gradient};
  const std::vector<int>& nodes = live_.nodes();
  for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) against.addNode(*i);
  reactions_.joints().forLive([&s](const JointBlock& b, int lane, int dof) { s.gradient[dof] -= b.impulse[lane]; });
}

// The gradient of a mimic's dof is its master's.
double IslandIterate::evaluateGradient() {
  gradient();
  SolverSpace& s = *island_->space;
  for (const MimicFold& m : island_->model.mimics) {
    s.gradient[m.master] += m.multiplier * s.gradient[m.dof];
    s.gradient[m.dof] = 0;
  }
  return gradientNorm(*island_, live_.dofs());
}

double IslandIterate::evaluateIdleGradient() {
  reactions_.respondIdle();
  SolverSpace& s = *island_->space;
  for (const int k : live_.idleDofs()) s.gradient[k] = s.kinetic[k];
  reactions_.joints().forIdle([&s](const JointBlock& b, int lane, int dof) { s.gradient[dof] -= b.impulse[lane]; });
  return gradientNorm(*island_, live_.idleDofs());
}

void IslandIterate::setDirection() {
  SolverSpace& s = *island_->space;
  for (const int tree : island_->model.trees)
    multiply({island_->forest, tree, s.idle.rows, &s.live}, s.direction, &s.mass_direction, &s.paths);
  reactions_.setSteps(s.direction);
}

double IslandIterate::move(double a) {
  SolverSpace& s = *island_->space;
  double moved = 0;
  for (const int k : live_.dofs()) {
    s.velocity[k] += a * s.direction[k];
    s.kinetic[k] += a * s.mass_direction[k];
    moved = std::max(moved, std::abs(a * s.direction[k]));
  }
  reactions_.take(a);
  return moved;
}

// The impulse of a fold is the gradient on the mimic's own dof.
void IslandIterate::read() {
  std::vector<double>* impulses = &island_->found->mimic_impulses;
  impulses->clear();
  if (!island_->model.mimics.empty()) {
    gradient();
    for (const MimicFold& m : island_->model.mimics) impulses->push_back(island_->space->gradient[m.dof]);
  }
  reactions_.contacts().read();
}

}  // namespace blem_sim::dynamics
