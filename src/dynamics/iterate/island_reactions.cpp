#include "iterate/island_reactions.h"

namespace blem_sim::dynamics {

void IslandReactions::begin(const IslandAtHand& island, const LiveParts& live) {
  island_ = &island;
  live_ = &live;
  joints_.order(island, live);
  contacts_.fill(island);
  setSteps(island.space->velocity);
  contacts_.take(1);
  contacts_.startSlips();
  for (LoopTerm& loop : loops()) loop.velocity = loop.step;
  soften(1, 1);
}

void IslandReactions::orderJoints() {
  responses_at_ = UNKNOWN;
  joints_.order(*island_, *live_);
  joints_.softenAgain();
}

void IslandReactions::soften(double contact, double joint) {
  responses_at_ = UNKNOWN;
  contacts_.soften(contact);
  joints_.soften(joint);
  for (LoopTerm& loop : loops()) loop.drive.softness = joint;
}

void IslandReactions::remember() {
  responses_at_ = UNKNOWN;
  contacts_.remember();
  joints_.remember();
  for (LoopTerm& loop : loops()) loop.remember();
}

void IslandReactions::expect() {
  contacts_.expect();
  joints_.expect();
  responses_at_ = 0;
}

void IslandReactions::adoptImpulses() {
  PotentialSlope unused;
  contacts_.adoptImpulses();
  joints_.respondLive(0, &unused);
  responses_at_ = 0;
}

void IslandReactions::setSteps(const Eigen::VectorXd& change) {
  std::vector<Vector6>* twist = &island_->space->twist;
  for (const int i : live_->nodes()) computeTwist(island_->forest, i, island_->motion, change, twist);
  contacts_.setSteps();
  joints_.setSteps(change);
  for (std::size_t l = 0; l < loops().size(); ++l)
    loops()[l].step = loops()[l].basis.transpose() * relativeTwist(island_->model.loop_pairs[l], *twist);
}

PotentialSlope IslandReactions::respond(double a) {
  PotentialSlope slope = contacts_.respond(a);
  joints_.respondLive(a, &slope);
  responses_at_ = a;
  return slope;
}

PotentialSlope IslandReactions::slope(double a, const PotentialSlope& kinetic) {
  PotentialSlope slope = respond(a);
  slope += kinetic;
  for (const LoopTerm& loop : loops()) {
    for (int r = 0; r < 6; ++r) {
      const double d = loop.step[r], v = loop.velocity[r] + a * d;
      slope.first -= loop.impulse(r, v) * d;
      slope.second += loop.stiffness(r, v) * d * d;
    }
  }
  return slope;
}

void IslandReactions::take(double a) {
  contacts_.take(a);
  joints_.take(a);
  for (LoopTerm& loop : loops()) loop.velocity += a * loop.step;
  responses_at_ = a == responses_at_ ? 0 : UNKNOWN;
}

void IslandReactions::sumWrenches() {
  SolverSpace& s = *island_->space;
  if (responses_at_ != 0) respond(0);
  for (const int i : live_->nodes()) s.wrench[i].setZero();
  contacts_.addWrenches();
  for (std::size_t l = 0; l < loops().size(); ++l)
    addWrench(island_->model.loop_pairs[l], loops()[l].basis * loops()[l].impulses(), &s.wrench);
}

}  // namespace blem_sim::dynamics
