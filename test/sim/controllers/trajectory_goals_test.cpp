#include <functional>

#include "sim/controllers/arm_controller.h"

namespace blem_sim::sim {
namespace {

class TrajectoryGoalsTest : public TrajectoryControllerTest {};

TEST_F(TrajectoryGoalsTest, AGoalSucceedsAtItsEnd) {
  make();
  controller_->accept(goalOf(path({{0.5, {0.5, -0.2}}, {1, {1, -0.4}}})));
  EXPECT_FALSE(outcomeWithin(0.999));
  const auto outcome = outcomeWithin(0.01);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::SUCCEEDED);
  EXPECT_EQ(outcome->error, GoalError::SUCCESSFUL);
  EXPECT_NEAR(simulator_.time(), 1.001, 1e-9) << "time counts from the next step";
  EXPECT_NEAR(position(0), 1, 1e-3);
  EXPECT_NEAR(position(1), -0.4, 1e-3);
  EXPECT_FALSE(controller_->hasGoal());
}

TEST_F(TrajectoryGoalsTest, AnEmptyGoalWithNamesStopsAndSucceeds) {
  make();
  controller_->command(path({{1, {1, 1}}}));
  ASSERT_FALSE(outcomeWithin(0.5));
  TrajectoryGoal goal;
  goal.trajectory.joints = {"swing", "spin"};
  controller_->accept(goal);
  const auto outcome = outcomeWithin(0.01);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::SUCCEEDED);
  EXPECT_LT(desired(0), 0.6);
}

TEST_F(TrajectoryGoalsTest, AViolatedPathToleranceAbortsTheGoalAndNotTheMotion) {
  make();
  TrajectoryGoal goal = goalOf(path({{0.5, {2, 0.1}}}));
  goal.path_tolerance = {{"swing", 1e-7, 0}};
  controller_->accept(goal);
  const auto outcome = outcomeWithin(0.4);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::ABORTED);
  EXPECT_EQ(outcome->error, GoalError::PATH_TOLERANCE_VIOLATED);
  EXPECT_TRUE(isOneLineWith(outcome->text, {"'swing'", "1e-07"})) << outcome->text;
  EXPECT_FALSE(outcomeWithin(1));
  EXPECT_NEAR(position(0), 2, 1e-3);
}

TEST_F(TrajectoryGoalsTest, GoalTolerancesWaitForTheGoalTime) {
  ControllerConfig config;
  config.joint_constraints["spin"].goal = 1e-12;
  config.stopped_velocity_tolerance = 0;
  config.goal_time = 0.05;
  make(config);
  controller_->accept(goalOf(path({{0.1, {0.5, 0.5}}})));
  const auto outcome = outcomeWithin(0.5);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->error, GoalError::GOAL_TOLERANCE_VIOLATED);
  EXPECT_TRUE(isOneLineWith(outcome->text, {"'spin'"})) << outcome->text;
  EXPECT_NEAR(simulator_.time(), 0.151, 1e-9);
}

TEST_F(TrajectoryGoalsTest, AGoalsTolerancesBeatTheControllers) {
  ControllerConfig config;
  for (const char* joint : {"swing", "spin"}) config.joint_constraints[joint] = {1e-12, 1e-12};
  config.goal_time = 5;
  make(config);
  TrajectoryGoal goal = goalOf(path({{0.1, {0.5, 0.5}}}));
  goal.path_tolerance = goal.goal_tolerance = {{"swing", 1, 0}, {"spin", -1, 0}};
  goal.goal_tolerance[0].velocity = goal.goal_tolerance[1].velocity = -1;
  goal.goal_time_tolerance = -1;
  controller_->accept(goal);
  const auto outcome = outcomeWithin(0.2);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::SUCCEEDED);
  goal.path_tolerance.pop_back();
  goal.trajectory = path({{0.1, {-0.5, -0.5}}});
  controller_->accept(goal);
  const auto violated = outcomeWithin(0.2);
  ASSERT_TRUE(violated);
  EXPECT_EQ(violated->error, GoalError::PATH_TOLERANCE_VIOLATED) << "without an entry the controller's own tolerance counts";
}

TEST_F(TrajectoryGoalsTest, AGoalDatedAheadLetsTheOldPathRun) {
  make();
  controller_->accept(goalOf(path({{1, {1, 1}}})));
  ASSERT_FALSE(outcomeWithin(0.2));
  TrajectoryGoal ahead = goalOf(path({{0.5, {0, 0}}}, 0.6));
  ahead.path_tolerance = {{"swing", 1e-2, 0}, {"spin", 1e-2, 0}};
  controller_->accept(ahead);
  const auto outcome = outcomeWithin(0.4);
  EXPECT_FALSE(outcome);
  JointSpline old_path(0);
  old_path.splice(0, 0.001, {{1.001, 1, 0, 0, 0, 3}}, false);
  EXPECT_NEAR(desired(0), old_path.sample(0.6).position, 1e-9);
  ASSERT_TRUE(outcomeWithin(0.6));
  EXPECT_NEAR(simulator_.time(), 1.1, 1e-9);
  EXPECT_NEAR(position(0), 0, 1e-3);
}

TEST_F(TrajectoryGoalsTest, ACommandEndsAGoal) {
  make();
  controller_->accept(goalOf(path({{1, {1, 1}}})));
  ASSERT_FALSE(outcomeWithin(0.2));
  EXPECT_THROW(controller_->command(path({{1, {NAN, 0}}})), InputError);
  EXPECT_TRUE(controller_->hasGoal()) << "a bad command changes nothing";
  controller_->command(path({{0.2, {0, 0}}}));
  EXPECT_FALSE(controller_->hasGoal());
  EXPECT_FALSE(outcomeWithin(0.5));
  EXPECT_NEAR(position(0), 0, 1e-3);
}

TEST_F(TrajectoryGoalsTest, OtherCommandsAndResetsEndAGoal) {
  make();
  const auto expectPreempted = [&](const std::function<void()>& act) {
    controller_->accept(goalOf(path({{1, {1, 1}}})));
    ASSERT_FALSE(outcomeWithin(0.1));
    act();
    const auto outcome = outcomeWithin(0.01);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->end, GoalEnd::PREEMPTED);
  };
  expectPreempted([&] { simulator_.commandTrajectory(0, path({{0.3, {0, 0}}})); });
  expectPreempted([&] { simulator_.commandJoints(0, {{"spin"}, {0.1}, {}, {}}); });
  expectPreempted([&] { simulator_.commandJoints(0, {{"spin"}, {}, {0.1}, {}}); });
  expectPreempted([&] { simulator_.resetWorld(); });
}

TEST_F(TrajectoryGoalsTest, ErrorsOfContinuousJointsGoTheShortWayRound) {
  ControllerConfig config;
  config.joint_constraints["spin"] = {0.1, 0.1};
  config.stopped_velocity_tolerance = 0.1;
  make(config);
  simulator_.commandTrajectory(0, path({{0.1, {0, 3}}, {0.2, {0, 6}}, {0.3, {0, 6.2}}}));
  stepFor(&simulator_, 0.5);
  EXPECT_NEAR(position(1), 6.2, 1e-3);
  controller_->accept(goalOf(path({{0.1, {0, 0}}})));
  const auto outcome = outcomeWithin(0.2);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::SUCCEEDED);
  EXPECT_NEAR(position(1), 2 * M_PI, 1e-3);
}

}  // namespace
}  // namespace blem_sim::sim
