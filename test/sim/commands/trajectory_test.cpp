#include "blem_sim/sim/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

const std::vector<std::string> JOINTS = {"hip", "knee", "ankle"};

JointTrajectory good() {
  JointTrajectory trajectory;
  trajectory.joints = {"ankle", "hip"};
  trajectory.points = {{0.0, {0, 1}, {0, 0}, {0, 0}, {}}, {1.0, {2, 3}, {}, {}, {5, 6}}};
  return trajectory;
}

std::string refusalOfTrajectory(void (*spoil)(JointTrajectory&)) {
  JointTrajectory trajectory = good();
  spoil(trajectory);
  return refusal([&] { checkTrajectory(trajectory, JOINTS); });
}

TEST(CheckTrajectory, AcceptsSomeJointsInAnyOrderAndNothing) {
  EXPECT_EQ(refusal([] { checkTrajectory(good(), JOINTS); }), "");
  EXPECT_EQ(refusal([] { checkTrajectory(JointTrajectory(), JOINTS); }), "");
  JointTrajectory old = good();
  old.points[0].time_from_start = -1;
  EXPECT_EQ(refusal([&] { checkTrajectory(old, JOINTS); }), "") << "old points are left out";
}

TEST(CheckTrajectory, RefusesInOneLine) {
  const auto expect = [](void (*spoil)(JointTrajectory&), std::initializer_list<std::string> words) {
    const std::string text = refusalOfTrajectory(spoil);
    EXPECT_TRUE(isOneLineWith(text, words)) << text;
  };
  expect([](JointTrajectory& t) { t.joints[0] = "anke"; }, {"'anke'", "unknown", "'ankle'"});
  expect([](JointTrajectory& t) { t.joints[0] = "hip"; }, {"'hip'", "twice"});
  expect([](JointTrajectory& t) { t.joints.clear(); }, {"name the joints"});
  expect([](JointTrajectory& t) { t.start_time = NAN; }, {"start time"});
  expect([](JointTrajectory& t) { t.points[1].positions = {1}; }, {"points[1].positions", "1 values for 2 joints"});
  expect([](JointTrajectory& t) { t.points[1].positions.clear(); }, {"points[1].positions", "0 values"});
  expect([](JointTrajectory& t) { t.points[0].velocities = {1}; }, {"points[0].velocities"});
  expect([](JointTrajectory& t) { t.points[0].accelerations = {1, 2, 3}; }, {"points[0].accelerations", "3 values"});
  expect([](JointTrajectory& t) { t.points[1].effort = {1}; }, {"points[1].effort"});
  expect([](JointTrajectory& t) { t.points[0].velocities.clear(); }, {"points[0]", "accelerations without velocities"});
  expect([](JointTrajectory& t) { t.points[1].positions[1] = NAN; }, {"points[1].positions", "'hip'", "finite"});
  expect([](JointTrajectory& t) { t.points[0].velocities[0] = INFINITY; }, {"points[0].velocities", "'ankle'"});
  expect([](JointTrajectory& t) { t.points[0].positions[0] = 1e308; }, {"points[0].positions", "'ankle'", "within 1e+07"});
  expect([](JointTrajectory& t) { t.points[1].effort[1] = -1e300; }, {"points[1].effort", "'hip'", "within 1e+07"});
  expect([](JointTrajectory& t) { t.start_time = 1e300; }, {"start time", "within 1e+10"});
  expect([](JointTrajectory& t) { t.points[1].time_from_start = 1e300; }, {"points[1].time_from_start", "1e+10"});
  expect([](JointTrajectory& t) { t.points[1].time_from_start = 0; }, {"points[1].time_from_start", "increase"});
  expect([](JointTrajectory& t) { t.points[1].time_from_start = NAN; }, {"points[1].time_from_start"});
  expect([](JointTrajectory& t) { t.points[0].time_from_start = -1e300; }, {"points[0].time_from_start", "1e+10"});
}

TEST(CheckTrajectory, ARobotWithoutJointsSaysSo) {
  const std::string text = refusal([] { checkTrajectory(good(), {}); });
  EXPECT_TRUE(isOneLineWith(text, {"'ankle'", "no movable joint"})) << text;
}

}  // namespace
}  // namespace blem_sim::sim
