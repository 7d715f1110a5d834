#include "blem_sim/sim/gripper_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sim/simulation_scene.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

/** A finger that slides 4 cm and another one that mimics it. */
const char* const GRIPPER = R"(<robot name="gripper"><link name="palm"/>
  <link name="left"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="right"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="finger" type="prismatic"><parent link="palm"/><child link="left"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="1"/></joint>
  <joint name="other_finger" type="prismatic"><parent link="palm"/><child link="right"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.04" effort="20" velocity="1"/><mimic joint="finger"/></joint></robot>)";

SimulationConfig gripperScene() {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.robots = {robot("gripper", GRIPPER, true)};
  config.robots[0].gains["default"] = {1000, 0, 50};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  return config;
}

ControllerConfig fingerConfig() {
  ControllerConfig config;
  config.name = "gripper_controller";
  config.kind = ControllerKind::GRIPPER;
  config.joints = {"finger"};
  config.goal_tolerance = 0.001;
  config.stall_timeout = 0.3;
  return config;
}

class GripperControllerTest : public testing::Test {
 protected:
  void SetUp() override { controller_.start(); }

  std::optional<GoalOutcome> outcomeWithin(double seconds) {
    for (long i = 0; i < std::lround(seconds / simulator_.config().time_step); ++i) {
      simulator_.step();
      if (const auto outcome = controller_.update()) return outcome;
    }
    return {};
  }

  Simulator simulator_{gripperScene(), model::UriResolver()};
  GripperController controller_{&simulator_, 0, fingerConfig()};
};

TEST_F(GripperControllerTest, ReachesAPositionWithAllFingers) {
  controller_.accept(0.02);
  const auto outcome = outcomeWithin(1);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::SUCCEEDED);
  EXPECT_TRUE(controller_.state().reached_goal);
  EXPECT_FALSE(controller_.state().stalled);
  EXPECT_NEAR(controller_.state().position, 0.02, 0.001);
  EXPECT_NEAR(simulator_.report().joints[1].position, simulator_.report().joints[0].position, 1e-6);
}

TEST_F(GripperControllerTest, StallsAgainstAStopWithAnEffort) {
  controller_.accept(0.05);
  const auto outcome = outcomeWithin(3);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::ABORTED);
  EXPECT_TRUE(isOneLineWith(outcome->text, {"stalled", "0.01 short"})) << outcome->text;
  EXPECT_TRUE(controller_.state().stalled);
  EXPECT_FALSE(controller_.state().reached_goal);
  EXPECT_NEAR(controller_.state().position, 0.04, 1e-4);
  EXPECT_GT(controller_.state().effort, 1) << "it presses";
}

TEST_F(GripperControllerTest, CancelHolds) {
  controller_.accept(0.04);
  ASSERT_FALSE(outcomeWithin(0.03));
  controller_.cancel();
  const double held = controller_.state().position;
  EXPECT_FALSE(outcomeWithin(1));
  EXPECT_NEAR(controller_.state().position, held, 0.005);
  EXPECT_LT(controller_.state().position, 0.035);
}

TEST_F(GripperControllerTest, RefusesWhatItCannotDo) {
  EXPECT_THROW(controller_.accept(NAN), GoalRefused);
  EXPECT_FALSE(outcomeWithin(0.01));
  controller_.stop();
  EXPECT_THROW(controller_.accept(0.02), GoalRefused);
  controller_.start();
  ControllerConfig config = fingerConfig();
  config.joints = {"other_finger"};
  EXPECT_TRUE(isOneLineWith(refusal([&] { GripperController(&simulator_, 0, config); }), {"'other_finger'", "mimics"}));
  config.joints = {};
  EXPECT_TRUE(isOneLineWith(refusal([&] { GripperController(&simulator_, 0, config); }), {"joint", "missing"}));
}

TEST_F(GripperControllerTest, AnotherCommandEndsTheGoal) {
  controller_.accept(0.02);
  simulator_.commandJoints(0, {{"finger"}, {0.01}, {}, {}});
  const auto outcome = outcomeWithin(0.01);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::PREEMPTED);
}

}  // namespace
}  // namespace blem_sim::sim
