// Contacts of an island while they are iterated: blocks of four, pair by pair, in loops that threads share.
#pragma once

#include <vector>

#include "lanes/contact_lanes.h"
#include "lanes/slip_mixing.h"
#include "problem/island_at_hand.h"

namespace blem_sim::dynamics {

class IslandContacts {
 public:
  /** Contacts of the terms at hand; their velocities begin with the bend of the bodies' paths. */
  void fill(const IslandAtHand& island);
  /** Proximal weights `softness` times the terms' own. */
  void soften(double softness);
  bool isSoft() const { return softness_ > 1; }

  /** Steps along the twists in the space. */
  void setSteps();
  /** Velocities move on by a times the steps. */
  void take(double a);
  /** Contacts that stay open slip as they do at the velocities at hand. */
  void startSlips() { dynamics::startSlips(begin(), end()); }
  /** Responses as if all went on as it was when the last step ended, linear though it is not. */
  void expect();
  /** Responses at velocity + a step. */
  PotentialSlope respond(double a);
  /** The present iterate becomes the proximal point, its slips mixed with those of the last ones. */
  void remember() { slip_mixing_.remember(begin(), end()); }
  /** SlipMixing::damp */
  void dampSlips(double share) { slip_mixing_.damp(share); }
  /** Slips are mixed anew from here on. */
  void forgetSlips() { slip_mixing_.start(blocks_.size() * LANES); }
  /** Impulses of the terms become those of the iterate, and the proximal point. */
  void adoptImpulses();
  /** Writes impulses and velocities to the terms. */
  void read() const;

  /** Adds the impulses' wrenches on the nodes to those in the space. */
  void addWrenches();
  /** Stiffness of a pair, about the reference point of its first body. @return false if no contact acts */
  bool stiffnessOf(std::size_t pair, Matrix6* out) const;
  /** [m/s] of the fastest contact. */
  double fastest() const { return dynamics::fastest(begin(), end()); }
  ContactResidual residual() const { return dynamics::residual(begin(), end()); }
  /** Whether the last proximal step changed no impulse by more than `share` of the largest. */
  bool areSettled(double share) const;
  const std::vector<ContactBlock>& blocks() const { return blocks_; }

  /** Visits each contact of the terms: visit(index, block, lane). */
  template <typename Visit>
  void forEach(const Visit& visit) const {
    for (std::size_t p = 0; p < ranges_.size(); ++p) {
      const PairContacts& of_pair = island_->model.pairs[p];
      for (int i = of_pair.first; i < of_pair.end; ++i)
        visit(i, ranges_[p].first + static_cast<std::size_t>(i - of_pair.first) / LANES, (i - of_pair.first) % LANES);
    }
  }

 private:
  struct BlockRange {
    std::size_t first, end;
  };
  ContactBlock* begin() { return blocks_.data(); }
  ContactBlock* end() { return blocks_.data() + blocks_.size(); }
  const ContactBlock* begin() const { return blocks_.data(); }
  const ContactBlock* end() const { return blocks_.data() + blocks_.size(); }
  template <typename Visit>
  void forRanges(const Visit& visit);

  const IslandAtHand* island_ = nullptr;
  std::vector<ContactBlock> blocks_;  // responses: at the line search's last step length
  std::vector<BlockRange> ranges_;    // by pair
  double softness_ = 1;
  SlipMixing slip_mixing_;
  std::vector<PotentialSlope> slopes_;  // by range of blocks
  std::vector<Vector6> pair_wrenches_;  // by pair
};

}  // namespace blem_sim::dynamics
