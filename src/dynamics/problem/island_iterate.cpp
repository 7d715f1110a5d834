#include "problem/island_iterate.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {

void IslandIterate::start(const IslandAtHand& island) {
  island_ = &island;
  SolverSpace& s = *island.space;
  const std::vector<MimicFold>& mimics = island.model.mimics;
  for (const MimicFold& m : mimics) s.velocity[m.dof] = m.multiplier * s.velocity[m.master];
  if (!mimics.empty())
    for (const int tree : island.model.trees) multiply(island.forest, tree, island.motion.mass, s.velocity, &s.mass_velocity, &s.paths);
  forDofs(island, [&](int k) { s.scale[k] = 1 / std::sqrt(island.motion.mass[island.forest.diagonal(k)]); });
  setKinetic();
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

void IslandIterate::setKinetic() {
  SolverSpace& s = *island_->space;
  forDofs(*island_, [&s](int k) { s.kinetic[k] = s.mass_velocity[k] - s.free_momentum[k]; });
}

void IslandIterate::keepFirst() {
  SolverSpace& s = *island_->space;
  forDofs(*island_, [&s](int k) {
    s.first_velocity[k] = s.velocity[k];
    s.first_kinetic[k] = s.kinetic[k];
  });
}

void IslandIterate::returnToFirst() {
  SolverSpace& s = *island_->space;
  forDofs(*island_, [&s](int k) {
    s.velocity[k] = s.first_velocity[k];
    s.kinetic[k] = s.first_kinetic[k];
  });
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
  contacts_.adoptImpulses();
  joints_.respondAll();
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
  return gradientNorm(live_.dofs());
}

double IslandIterate::evaluateIdleGradient() {
  SolverSpace& s = *island_->space;
  for (const int k : live_.idleDofs()) s.gradient[k] = s.kinetic[k];
  joints_.forIdle([&s](const JointBlock& b, int lane, int dof) { s.gradient[dof] -= b.impulse[lane]; });
  return gradientNorm(live_.idleDofs());
}

double IslandIterate::gradientNorm(const std::vector<int>& dofs) const {
  const SolverSpace& s = *island_->space;
  double worst = 0;
  for (const int k : dofs) worst = std::max(worst, std::abs(s.gradient[k]) * s.scale[k]);
  return worst;
}

double IslandIterate::imbalance() const {
  const SolverSpace& s = *island_->space;
  double worst = 0;
  forDofs(*island_, [&](int k) { worst = std::max(worst, std::abs(s.gradient[k]) * s.scale[k] * s.scale[k]); });
  return worst;
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

void IslandIterate::addLoopSlope(double a, PotentialSlope* slope) const {
  for (const LoopTerm& loop : island_->terms()->loops) {
    for (int r = 0; r < 6; ++r) {
      const double d = loop.step[r], v = loop.velocity[r] + a * d;
      slope->first -= loop.impulse(r, v) * d;
      slope->second += loop.stiffness(r, v) * d * d;
    }
  }
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
