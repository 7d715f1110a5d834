#include "mimic_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace blem_sim::model {
namespace {

constexpr double NOTHING = 0.01;  // share of a range that is none, or that need not be told

struct Range {
  double lower, upper;

  double length() const { return upper - lower; }
  bool ends() const { return std::isfinite(length()); }
};

std::string told(const Range& range) {
  return range.ends() ? fmt::format("goes from {:.4g} to {:.4g}", range.lower, range.upper) : "moves without end";
}

/** Whether a way is so little less than the whole range that it need not be told. */
bool isWhole(const Range& way, const Range& own) {
  return own.ends() ? way.length() >= (1 - NOTHING) * own.length() : way.lower <= own.lower && way.upper >= own.upper;
}

/** Range of the leader's positions at which both hold their limits; of length 0 or less: none. */
Range wayOf(const MimicLeader& leader, const JointLimits& of_leader, const JointLimits& of_follower) {
  const Range own{of_leader.lower, of_leader.upper};
  if (leader.multiplier == 0) {
    const bool holds = of_follower.lower <= leader.offset && leader.offset <= of_follower.upper;
    return holds ? own : Range{own.lower, own.lower};
  }
  const double a = (of_follower.lower - leader.offset) / leader.multiplier, b = (of_follower.upper - leader.offset) / leader.multiplier;
  return {0 + std::max(own.lower, std::min(a, b)), 0 + std::min(own.upper, std::max(a, b))};  // 0: never -0
}

}  // namespace

MimicLeader mimicLeader(const LumpedRobot& robot, const LumpedJoint& follower) {
  MimicLeader leader;
  const LumpedJoint* at = &follower;
  for (std::size_t chain = 0; at->mimic && chain < robot.joints.size(); ++chain) {
    leader.offset += leader.multiplier * at->mimic->offset;
    leader.multiplier *= at->mimic->multiplier;
    const auto next =
        std::find_if(robot.joints.begin(), robot.joints.end(), [&](const LumpedJoint& j) { return j.name == at->mimic->joint; });
    leader.joint = next == robot.joints.end() ? -1 : static_cast<int>(next - robot.joints.begin());
    if (leader.joint < 0) break;
    at = &*next;
  }
  return leader;
}

void bringLimitsTogether(LumpedRobot* robot) {
  for (LumpedJoint& follower : robot->joints) {
    if (!follower.mimic || !follower.moves() || follower.type == JointType::CONTINUOUS) continue;
    const MimicLeader found = mimicLeader(*robot, follower);
    if (found.joint < 0) continue;
    LumpedJoint& leader = robot->joints[found.joint];
    const Range own{leader.limits.lower, leader.limits.upper}, way = wayOf(found, leader.limits, follower.limits);
    if (isWhole(way, own)) continue;
    const std::string follows = fmt::format("joint '{}' follows '{}', which {}; its own limits, {:.4g} to {:.4g},", follower.name,
                                            leader.name, told(own), follower.limits.lower, follower.limits.upper);
    if (way.length() > (own.ends() ? NOTHING * own.length() : 0)) {
      leader.type = leader.type == JointType::CONTINUOUS ? JointType::REVOLUTE : leader.type;
      leader.limits.lower = way.lower;
      leader.limits.upper = way.upper;
      robot->notes.push_back(fmt::format("{} leave that only {:.4g} to {:.4g}", follows, way.lower, way.upper));
    } else {
      follower.limits.lower = JointLimits().lower;
      follower.limits.upper = JointLimits().upper;
      robot->notes.push_back(follows + " leave that no way and are not kept; correct <limit> or <mimic>");
    }
  }
}

}  // namespace blem_sim::model
