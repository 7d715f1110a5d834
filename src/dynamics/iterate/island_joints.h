// Joints of an island while they are iterated: blocks of four, those of live dofs first, in blocks of their own.
#pragma once

#include <vector>

#include "iterate/live_parts.h"
#include "lanes/contact_lanes.h"
#include "lanes/joint_lanes.h"

namespace blem_sim::dynamics {

class IslandJoints {
 public:
  /** Orders the joints of the terms at hand by what is live; their velocities are those in the space. soften() sets the rest. */
  void order(const IslandAtHand& island, const LiveParts& live);
  /** Divides the gains of live joints' friction and limits; idle ones are never softened. */
  void soften(double softness);
  /** The same with the softness at hand, for joints that were ordered anew. */
  void softenAgain() { soften(softness_); }

  /** Steps of live joints along a direction. */
  void setSteps(const Eigen::VectorXd& direction);
  /** Velocities of live joints move on by a times the steps. */
  void take(double a);
  /** Responses as if all joints went on as they were when the last step ended. */
  void expect();
  /** Responses of live joints at velocity + a step, their slope added. */
  void respondLive(double a, PotentialSlope* slope);
  /** Responses of idle joints at the velocities in the space. */
  void respondIdle();
  /** The impulses at the velocities in the space become the proximal points. */
  void remember();
  /** [rad/s or m/s] of the worst joint. */
  double creep() const { return dynamics::creep(blocks_.data(), blocks_.data() + blocks_.size()); }

  /** Visits live joints: visit(block, lane, dof). */
  template <typename Visit>
  void forLive(const Visit& visit) const {
    visitLanes(0, live_blocks_, visit);
  }
  template <typename Visit>
  void forIdle(const Visit& visit) const {
    visitLanes(live_blocks_, blocks_.size(), visit);
  }
  /** Blocks of live joints; lanes without a joint have stiffness 0. */
  const JointBlock* liveBegin() const { return blocks_.data(); }
  const JointBlock* liveEnd() const { return blocks_.data() + live_blocks_; }

 private:
  template <typename Visit>
  void visitLanes(std::size_t first, std::size_t end, const Visit& visit) const {
    for (std::size_t b = first; b < end; ++b)
      for (int lane = 0; lane < LANES; ++lane)
        if (blocks_[b].dof[lane] >= 0) visit(blocks_[b], lane, blocks_[b].dof[lane]);
  }
  const JointTerm* termOf(std::size_t block, int lane) const;
  void setLanes();

  const IslandAtHand* island_ = nullptr;
  const LiveParts* live_ = nullptr;
  std::vector<int> order_;          // of the lanes: index of the term, -1 none
  std::vector<JointBlock> blocks_;  // responses: at the line search's last step length
  std::size_t live_blocks_ = 0;
  double softness_ = 1;
};

}  // namespace blem_sim::dynamics
