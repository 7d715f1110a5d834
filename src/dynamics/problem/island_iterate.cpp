#include "problem/island_iterate.h"

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
  forDofs(island, [&](int k) { s.scale[k] = 1 / std::sqrt(island.motion.mass[island.forest.diagonal(k)]); });
  setKinetic(island);
  live_.find(island);
  begin();
  first_speed_ = contacts_.fastest();
}

void IslandIterate::begin() {
  live_.list();
  joints_.order(*island_, live_);
  contacts_.fill(*island_);
  setSteps(island_->space->velocity);
  contacts_.take(1);
  contacts_.startSlips();
  for (LoopTerm& loop : island_->terms()->loops) loop.velocity = loop.step;
  soften(1, 1);
}

void IslandIterate::takeWoken() {
  responses_at_ = UNKNOWN;
  live_.list();
  joints_.order(*island_, live_);
  joints_.softenAgain();
}

void IslandIterate::soften(double contact, double joint) {
  responses_at_ = UNKNOWN;
  contacts_.soften(contact);
  joints_.soften(joint);
  for (LoopTerm& loop : island_->terms()->loops) loop.drive.softness = joint;
}

void IslandIterate::remember() {
  responses_at_ = UNKNOWN;
  contacts_.remember();
  joints_.remember();
  for (LoopTerm& loop : island_->terms()->loops) loop.remember();
}

void IslandIterate::expect() {
  contacts_.expect();
  joints_.expect();
  responses_at_ = 0;
}

void IslandIterate::adoptImpulses() {
  PotentialSlope unused;
  contacts_.adoptImpulses();
  joints_.respondLive(0, &unused);
  responses_at_ = 0;
}

// Impulses at the present iterate, as wrenches on the nodes.
void IslandIterate::evaluate() {
  SolverSpace& s = *island_->space;
  if (responses_at_ != 0) respond(0);
  for (const int i : live_.nodes()) s.wrench[i].setZero();
  contacts_.addWrenches();
  const std::vector<LoopTerm>& loops = island_->terms()->loops;
  for (std::size_t l = 0; l < loops.size(); ++l) addWrench(island_->model.loop_pairs[l], loops[l].basis * loops[l].impulses(), &s.wrench);
}

void IslandIterate::gradient() {
  SolverSpace& s = *island_->space;
  for (const int k : live_.dofs()) s.gradient[k] = s.kinetic[k];
  const std::vector<int>& nodes = live_.nodes();
  for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) addProjectedNode(island_->forest, *i, island_->motion, -1, &s.wrench, &s.gradient);
  joints_.forLive([&s](const JointBlock& b, int lane, int dof) { s.gradient[dof] -= b.impulse[lane]; });
}

// The gradient of a mimic's dof is its master's.
double IslandIterate::evaluateGradient() {
  evaluate();
  gradient();
  SolverSpace& s = *island_->space;
  for (const MimicFold& m : island_->model.mimics) {
    s.gradient[m.master] += m.multiplier * s.gradient[m.dof];
    s.gradient[m.dof] = 0;
  }
  return gradientNorm(*island_, live_.dofs());
}

double IslandIterate::evaluateIdleGradient() {
  respondIdle();
  SolverSpace& s = *island_->space;
  for (const int k : live_.idleDofs()) s.gradient[k] = s.kinetic[k];
  joints_.forIdle([&s](const JointBlock& b, int lane, int dof) { s.gradient[dof] -= b.impulse[lane]; });
  return gradientNorm(*island_, live_.idleDofs());
}

void IslandIterate::setDirection() {
  SolverSpace& s = *island_->space;
  for (const int tree : island_->model.trees)
    multiply(island_->forest, tree, s.idle.rows, s.direction, &s.mass_direction, &s.paths, &s.live);
  setSteps(s.direction);
}

void IslandIterate::setSteps(const Eigen::VectorXd& change) {
  std::vector<Vector6>* twist = &island_->space->twist;
  for (const int i : live_.nodes()) computeTwist(island_->forest, i, island_->motion, change, twist);
  contacts_.setSteps();
  joints_.setSteps(change);
  std::vector<LoopTerm>& loops = island_->terms()->loops;
  for (std::size_t l = 0; l < loops.size(); ++l)
    loops[l].step = loops[l].basis.transpose() * relativeTwist(island_->model.loop_pairs[l], *twist);
}

PotentialSlope IslandIterate::respond(double a) {
  PotentialSlope slope = contacts_.respond(a);
  joints_.respondLive(a, &slope);
  responses_at_ = a;
  return slope;
}

PotentialSlope IslandIterate::slope(double a, const PotentialSlope& kinetic) {
  PotentialSlope slope = respond(a);
  slope += kinetic;
  for (const LoopTerm& loop : island_->terms()->loops) {
    for (int r = 0; r < 6; ++r) {
      const double d = loop.step[r], v = loop.velocity[r] + a * d;
      slope.first -= loop.impulse(r, v) * d;
      slope.second += loop.stiffness(r, v) * d * d;
    }
  }
  return slope;
}

double IslandIterate::move(double a) {
  SolverSpace& s = *island_->space;
  double moved = 0;
  for (const int k : live_.dofs()) {
    s.velocity[k] += a * s.direction[k];
    s.kinetic[k] += a * s.mass_direction[k];
    moved = std::max(moved, std::abs(a * s.direction[k]));
  }
  contacts_.take(a);
  joints_.take(a);
  for (LoopTerm& loop : island_->terms()->loops) loop.velocity += a * loop.step;
  responses_at_ = a == responses_at_ ? 0 : UNKNOWN;
  return moved;
}

// The impulse of a fold is the gradient on the mimic's own dof.
void IslandIterate::read() {
  std::vector<double>* impulses = &island_->found->mimic_impulses;
  impulses->clear();
  if (!island_->model.mimics.empty()) {
    evaluate();
    gradient();
    for (const MimicFold& m : island_->model.mimics) impulses->push_back(island_->space->gradient[m.dof]);
  }
  contacts_.read();
}

}  // namespace blem_sim::dynamics
