// Limits of joints that mimic others, as URDFs of grippers have them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

#include "blem_sim/model/loaders.h"
#include "support/shared_data.h"
#include "support/shared_packages.h"

namespace blem_sim::model {
namespace {

constexpr double ENDLESS_RANGE = std::numeric_limits<double>::infinity();

std::string handJoint(const std::string& name, const std::string& type, double lower, double upper, const std::string& mimic = "") {
  return fmt::format(
      R"(<link name="{0}_link"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)"
      R"(</link><joint name="{0}" type="{1}"><parent link="base"/><child link="{0}_link"/>)"
      R"(<limit lower="{2}" upper="{3}" effort="1" velocity="1"/>{4}</joint>)",
      name, type, lower, upper, mimic);
}
std::string mimic(const std::string& leader, double multiplier, double offset = 0) {
  return fmt::format(R"(<mimic joint="{}" multiplier="{}" offset="{}"/>)", leader, multiplier, offset);
}

/** Joint 0 is the leader. */
LumpedRobot hand(const std::string& joints) {
  const std::string urdf = R"(<robot name="hand"><link name="base"/>)" + joints + "</robot>";
  return lumpFixedJoints(loadUrdf(urdf, "hand.urdf", UriResolver()), {}, true);
}

void expectLimits(const LumpedJoint& joint, double lower, double upper) {
  EXPECT_DOUBLE_EQ(joint.limits.lower, lower) << joint.name;
  EXPECT_DOUBLE_EQ(joint.limits.upper, upper) << joint.name;
}

TEST(MimicLimits, ThatFitStayWithoutAWord) {
  const LumpedRobot robot = hand(handJoint("a", "revolute", 0, 0.8) + handJoint("b", "revolute", -0.4, 0.1, mimic("a", -0.5)) +
                                 handJoint("c", "revolute", 0.9996, 1.7996, mimic("a", 1, 1)));
  expectLimits(robot.joints[0], 0, 0.8);
  expectLimits(robot.joints[1], -0.4, 0.1);
  EXPECT_TRUE(robot.notes.empty()) << robot.notes[0];
}

TEST(MimicLimits, ThatLeaveNoWayAreNotKept) {
  for (const auto& [multiplier, offset] : {std::make_pair(-1.0, 0.0), {1.0, 5.0}, {0.0, -1.0}, {-1.0, 0.004}}) {
    const LumpedRobot robot = hand(handJoint("a", "revolute", 0, 0.8) + handJoint("b", "revolute", 0, 0.9, mimic("a", multiplier, offset)));
    expectLimits(robot.joints[0], 0, 0.8);
    expectLimits(robot.joints[1], -ENDLESS_RANGE, ENDLESS_RANGE);
    ASSERT_EQ(robot.notes.size(), 1u);
    EXPECT_NE(robot.notes[0].find("'b' follows 'a'"), std::string::npos) << robot.notes[0];
    EXPECT_NE(robot.notes[0].find("correct <limit> or <mimic>"), std::string::npos) << robot.notes[0];
  }
}

TEST(MimicLimits, ThatLeaveSomeWayBoundTheLeader) {
  // A chain: c follows a by -2 b + 1 = 1 - 4 a, between 0 and 0.6 from a = 0.1 to 0.25.
  const LumpedRobot robot = hand(handJoint("a", "revolute", 0, 0.8) + handJoint("b", "revolute", -1, 2, mimic("a", 2)) +
                                 handJoint("c", "prismatic", 0, 0.6, mimic("b", -2, 1)));
  expectLimits(robot.joints[0], 0.1, 0.25);
  ASSERT_EQ(robot.notes.size(), 1u);
  EXPECT_NE(robot.notes[0].find("leave that only 0.1 to 0.25"), std::string::npos) << robot.notes[0];
}

TEST(MimicLimits, BoundALeaderThatTurnedWithoutEnd) {
  const LumpedRobot robot = hand(handJoint("a", "continuous", 0, 0) + handJoint("b", "revolute", 0, 0.6, mimic("a", -1)) +
                                 handJoint("c", "revolute", -1, 1, mimic("a", 4)));
  EXPECT_EQ(robot.joints[0].type, JointType::REVOLUTE);
  expectLimits(robot.joints[0], -0.25, 0);
  expectLimits(robot.joints[1], 0, 0.6);
  ASSERT_EQ(robot.notes.size(), 2u);
  EXPECT_NE(robot.notes[0].find("moves without end"), std::string::npos) << robot.notes[0];
  EXPECT_NE(robot.notes[0].find("leave that only -0.6 to 0"), std::string::npos) << robot.notes[0];
}

TEST(MimicLimits, OfALeaderWithoutEndThatLeaveNoWayAreNotKept) {
  const LumpedRobot robot = hand(handJoint("a", "continuous", 0, 0) + handJoint("b", "revolute", 0, 0.6, mimic("a", 0, 1)));
  EXPECT_EQ(robot.joints[0].type, JointType::CONTINUOUS);
  expectLimits(robot.joints[0], -ENDLESS_RANGE, ENDLESS_RANGE);
  expectLimits(robot.joints[1], -ENDLESS_RANGE, ENDLESS_RANGE);
  ASSERT_EQ(robot.notes.size(), 1u);
}

TEST(MimicLimits, OfFollowersWithoutEndLeaveTheLeaderFree) {
  const LumpedRobot robot = hand(handJoint("a", "continuous", 0, 0) + handJoint("b", "continuous", 0, 0, mimic("a", -1)));
  EXPECT_EQ(robot.joints[0].type, JointType::CONTINUOUS);
  EXPECT_TRUE(robot.notes.empty());
}

TEST(MimicLimits, OfARobotiqGripperLetItClose) {
  const auto file = sharedData("robots/robotiq_arg85_description/robots/robotiq_arg85_description.urdf");
  if (!file) GTEST_SKIP() << "shared data not found";
  const LumpedRobot robot = lumpFixedJoints(loadUrdfFile(*file, UriResolver(sharedPackages())), {}, true);
  for (const LumpedJoint& j : robot.joints) {
    if (!j.mimic) continue;
    const MimicLeader leader = mimicLeader(robot, j);
    const JointLimits& limits = robot.joints[leader.joint].limits;
    for (const double q : {limits.lower, limits.upper}) {
      EXPECT_LE(j.limits.lower, leader.multiplier * q + leader.offset) << j.name;
      EXPECT_GE(j.limits.upper, leader.multiplier * q + leader.offset) << j.name;
    }
    EXPECT_DOUBLE_EQ(limits.upper, 0.725);
  }
}

}  // namespace
}  // namespace blem_sim::model
