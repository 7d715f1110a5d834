#include "iterate/island_joints.h"

namespace blem_sim::dynamics {

void IslandJoints::order(const IslandAtHand& island, const LiveParts& live) {
  island_ = &island;
  live_ = &live;
  const std::vector<JointTerm>& terms = island.terms()->joints;
  order_.clear();
  order_.reserve(terms.size() + 2 * LANES);
  blocks_.reserve(terms.size() / LANES + 2);
  const auto add = [&](bool idle) {
    for (std::size_t j = 0; j < terms.size(); ++j)
      if (live.isIdle(terms[j].dof) == idle) order_.push_back(static_cast<int>(j));
    while (order_.size() % LANES != 0) order_.push_back(-1);
  };
  add(false);
  live_blocks_ = order_.size() / LANES;
  add(true);
  blocks_.resize(order_.size() / LANES);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    for (int lane = 0; lane < LANES; ++lane) {
      const JointTerm* term = termOf(b, lane);
      blocks_[b].dof[lane] = term ? term->dof : JointTerm().dof;
      blocks_[b].velocity[lane] = term ? island.space->velocity[term->dof] : 0;
    }
  }
}

const JointTerm* IslandJoints::termOf(std::size_t block, int lane) const {
  const int term = order_[block * LANES + lane];
  return term < 0 ? nullptr : &island_->terms()->joints[term];
}

void IslandJoints::setLanes() {
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int lane = 0; lane < LANES; ++lane) setLane(termOf(b, lane), lane, &blocks_[b]);
}

void IslandJoints::soften(double softness) {
  softness_ = softness;
  for (JointTerm& j : island_->terms()->joints) j.softness = live_->isIdle(j.dof) ? 1 : softness;
  setLanes();
}

void IslandJoints::setSteps(const Eigen::VectorXd& direction) {
  for (std::size_t b = 0; b < live_blocks_; ++b)
    for (int lane = 0; lane < LANES; ++lane) blocks_[b].step[lane] = blocks_[b].dof[lane] >= 0 ? direction[blocks_[b].dof[lane]] : 0;
}

void IslandJoints::take(double a) {
  for (std::size_t b = 0; b < live_blocks_; ++b)
    for (int lane = 0; lane < LANES; ++lane) blocks_[b].velocity[lane] += a * blocks_[b].step[lane];
}

void IslandJoints::expect() {
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int lane = 0; lane < LANES; ++lane) dynamics::expect(termOf(b, lane), lane, &blocks_[b]);
}

void IslandJoints::respondLive(double a, PotentialSlope* slope) {
  dynamics::respond(a, blocks_.data(), blocks_.data() + live_blocks_, &slope->first, &slope->second);
}

void IslandJoints::respondIdle() {
  for (std::size_t b = live_blocks_; b < blocks_.size(); ++b)
    for (int lane = 0; lane < LANES; ++lane)
      if (blocks_[b].dof[lane] >= 0) blocks_[b].velocity[lane] = island_->space->velocity[blocks_[b].dof[lane]];
  double first = 0, second = 0;
  dynamics::respond(0, blocks_.data() + live_blocks_, blocks_.data() + blocks_.size(), &first, &second);
}

void IslandJoints::remember() {
  for (JointTerm& j : island_->terms()->joints) j.remember(island_->space->velocity[j.dof]);
  setLanes();
}

}  // namespace blem_sim::dynamics
