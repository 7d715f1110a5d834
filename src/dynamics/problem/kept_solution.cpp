#include "problem/kept_solution.h"

namespace blem_sim::dynamics {

void KeptSolution::take(const IslandAtHand& island) {
  velocity_.clear();
  impulses_.clear();
  forDofs(island, [&](int k) { velocity_.push_back(island.space->velocity[k]); });
  for (const ContactTerm& c : island.terms()->contacts) impulses_.push_back(c.impulse);
  joints_ = island.terms()->joints;
  loops_ = island.terms()->loops;
}

void KeptSolution::put(const IslandAtHand& island) const {
  const double* next = velocity_.data();
  forDofs(island, [&](int k) { island.space->velocity[k] = *next++; });
  for (std::size_t i = 0; i < impulses_.size(); ++i) island.terms()->contacts[i].impulse = impulses_[i];
  island.terms()->joints = joints_;
  island.terms()->loops = loops_;
}

}  // namespace blem_sim::dynamics
