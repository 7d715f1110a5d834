#include "sim/controllers/arm_controller.h"

namespace blem_sim::sim {
namespace {

TEST_F(TrajectoryControllerTest, ControlsAllJointsThatHaveAMotor) {
  make();
  EXPECT_EQ(controller_->joints(), (std::vector<std::string>{"swing", "spin"}));
}

TEST_F(TrajectoryControllerTest, RefusesJointsItCannotControl) {
  const auto refused = [&](const ControllerConfig& config) { return refusal([&] { make(config); }); };
  ControllerConfig config;
  config.joints = {"swong"};
  EXPECT_TRUE(isOneLineWith(refused(config), {"'swong'", "'swing'"}));
  config.joints = {"shadow"};
  EXPECT_TRUE(isOneLineWith(refused(config), {"'shadow'", "mimics", "leave it out"}));
  config.joints = {"swing"};
  config.joint_constraints["spin"].goal = 1;
  EXPECT_TRUE(isOneLineWith(refused(config), {"'spin'", "constraints"}));
}

TEST_F(TrajectoryControllerTest, JointsMayComeInAnyOrder) {
  make();
  JointTrajectory trajectory = path({{0.5, {0.3, -0.7}}});
  trajectory.joints = {"spin", "swing"};
  controller_->accept(goalOf(trajectory));
  ASSERT_TRUE(outcomeWithin(0.6));
  EXPECT_NEAR(position(0), -0.7, 1e-3);
  EXPECT_NEAR(position(1), 0.3, 1e-3);
}

TEST_F(TrajectoryControllerTest, WrongJointsAreInvalidJoints) {
  make();
  const auto codeFor = [&](const std::vector<std::string>& joints, std::size_t values) {
    JointTrajectory trajectory;
    trajectory.joints = joints;
    trajectory.points = {{1, std::vector<double>(values, 0.1), {}, {}, {}}};
    return refusalOf(goalOf(trajectory));
  };
  EXPECT_EQ(codeFor({"swing"}, 1), GoalError::INVALID_JOINTS);
  EXPECT_EQ(codeFor({"swing", "other"}, 2), GoalError::INVALID_JOINTS);
  EXPECT_EQ(codeFor({"swing", "swing"}, 2), GoalError::INVALID_JOINTS);
  EXPECT_EQ(codeFor({"swing", "spin", "shadow"}, 3), GoalError::INVALID_JOINTS);
  EXPECT_EQ(codeFor({}, 0), GoalError::INVALID_JOINTS);
  EXPECT_EQ(refusalOf(goalOf({})), GoalError::INVALID_JOINTS);
  EXPECT_FALSE(controller_->hasGoal());
}

TEST_F(TrajectoryControllerTest, PartialGoalsIfAllowed) {
  ControllerConfig config;
  config.allow_partial_joints_goal = true;
  config.stopped_velocity_tolerance = 0.1;
  make(config);
  controller_->command(path({{1, {0.4, 0.6}}}));
  ASSERT_FALSE(outcomeWithin(0.5));
  JointTrajectory partial;
  partial.joints = {"swing"};
  partial.points = {{0.2, {-0.3}, {0}, {}, {}}};
  controller_->accept(goalOf(partial));
  const auto outcome = outcomeWithin(0.3);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::SUCCEEDED);
  EXPECT_FALSE(outcomeWithin(0.5));
  EXPECT_NEAR(position(0), -0.3, 1e-3);
  EXPECT_NEAR(position(1), 0.6, 1e-3) << "the other joint goes on";
}

TEST_F(TrajectoryControllerTest, BadPointsAreAnInvalidGoalAsAWhole) {
  make();
  const auto codeFor = [&](void (*spoil)(JointTrajectory&)) {
    JointTrajectory trajectory = path({{0.5, {0.1, 0.2}}, {1, {0.3, 0.4}}});
    spoil(trajectory);
    return refusalOf(goalOf(trajectory));
  };
  EXPECT_EQ(codeFor([](JointTrajectory& t) { t.points[1].time_from_start = 0.5; }), GoalError::INVALID_GOAL);
  EXPECT_EQ(codeFor([](JointTrajectory& t) { t.points[1].positions = {1}; }), GoalError::INVALID_GOAL);
  EXPECT_EQ(codeFor([](JointTrajectory& t) { t.points[1].positions[0] = NAN; }), GoalError::INVALID_GOAL);
  EXPECT_EQ(codeFor([](JointTrajectory& t) { t.points[0].velocities = {1}; }), GoalError::INVALID_GOAL);
  TrajectoryGoal goal = goalOf(path({{1, {0.3, 0.4}}}));
  goal.path_tolerance = {{"swing", NAN, 0}};
  EXPECT_EQ(refusalOf(goal), GoalError::INVALID_GOAL);
  EXPECT_FALSE(outcomeWithin(0.2));
  EXPECT_EQ(position(0), 0);
}

TEST_F(TrajectoryControllerTest, TolerancesAreForItsJoints) {
  make();
  TrajectoryGoal path_goal = goalOf(path({{1, {0.3, 0.4}}})), end_goal = path_goal;
  path_goal.path_tolerance = end_goal.goal_tolerance = {{"swing", 1, 0}, {"swnig", 1, 0}};
  EXPECT_EQ(refusalOf(path_goal), GoalError::INVALID_JOINTS);
  EXPECT_EQ(refusalOf(end_goal), GoalError::INVALID_JOINTS);
  EXPECT_FALSE(outcomeWithin(0.2));
  EXPECT_EQ(position(0), 0);
}

TEST_F(TrajectoryControllerTest, OldPointsAreDroppedAndAllOldIsRefused) {
  make();
  stepFor(&simulator_, 1);
  EXPECT_EQ(refusalOf(goalOf(path({{0.2, {1, 1}}, {0.5, {2, 2}}}, 0.4))), GoalError::INVALID_GOAL);
  EXPECT_EQ(refusalOf(goalOf(path({{0.501, {1, 1}}}, 0.5))), GoalError::INVALID_GOAL) << "at the next step is old";
  EXPECT_EQ(refusalOf(goalOf(path({{0, {1, 1}}}))), GoalError::INVALID_GOAL);
  EXPECT_EQ(controller_->accept(goalOf(path({{0.2, {5, 5}}, {1, {0.3, 0.1}}}, 0.5))), 1);
  const auto outcome = outcomeWithin(0.6);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::SUCCEEDED);
  EXPECT_NEAR(simulator_.time(), 1.5, 1e-9);
  EXPECT_EQ(controller_->command(path({{-1, {5, 5}}, {0.1, {0.2, 0.1}}})), 1) << "a negative time is old";
}

TEST_F(TrajectoryControllerTest, PointsBeforeAStartToComeAreOld) {
  make();
  stepFor(&simulator_, 1);
  EXPECT_EQ(refusalOf(goalOf(path({{-0.3, {1, 1}}, {-0.1, {2, 2}}}, 2))), GoalError::INVALID_GOAL);
  EXPECT_EQ(controller_->accept(goalOf(path({{-0.1, {5, 5}}, {1, {0.3, 0.1}}}, 1.5))), 1);
  stepFor(&simulator_, 0.45);
  EXPECT_NEAR(controller_->state()[0].desired.position, 0, 1e-9);
  const SimulationState state = simulator_.save();
  simulator_.restore(state);
  const auto outcome = outcomeWithin(1.2);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->end, GoalEnd::SUCCEEDED);
}

TEST_F(TrajectoryControllerTest, AnEmptyTrajectoryHoldsTheActualPosition) {
  make();
  controller_->command(path({{0.5, {1, 1}}}));
  ASSERT_FALSE(outcomeWithin(0.25));
  const double actual = position(0);
  EXPECT_NE(actual, desired(0)) << "the motor lags";
  controller_->command({});
  EXPECT_EQ(desired(0), actual);
  EXPECT_EQ(controller_->state()[0].desired.velocity, 0);
  ASSERT_FALSE(outcomeWithin(0.5));
  EXPECT_NEAR(position(0), actual, 1e-6);
}

TEST_F(TrajectoryControllerTest, AStopDurationRampsFromTheDesiredState) {
  ControllerConfig config;
  config.stop_trajectory_duration = 0.2;
  make(config);
  controller_->command(path({{0.5, {1, 1}}}));
  ASSERT_FALSE(outcomeWithin(0.25));
  const JointSample before = controller_->state()[0].desired;
  controller_->command({});
  EXPECT_NEAR(controller_->query(simulator_.time())[0].velocity, before.velocity, 1e-9);
  EXPECT_NEAR(controller_->query(simulator_.time() + 0.1)[0].velocity, before.velocity / 2, 1e-9);
  const JointSample rest = controller_->query(simulator_.time() + 0.2)[0];
  EXPECT_NEAR(rest.velocity, 0, 1e-9);
  EXPECT_NEAR(rest.position, before.position + before.velocity * 0.1, 1e-9);
}

TEST_F(TrajectoryControllerTest, CancelHolds) {
  make();
  controller_->accept(goalOf(path({{1, {1, 1}}})));
  ASSERT_FALSE(outcomeWithin(0.5));
  controller_->cancel();
  const double held = position(0);
  EXPECT_FALSE(outcomeWithin(0.6));
  EXPECT_NEAR(position(0), held, 1e-6);
}

TEST_F(TrajectoryControllerTest, OneThatNeverRanLeavesTheJointsAlone) {
  make();
  controller_->command(path({{1, {1, 1}}}));
  TrajectoryController other(&simulator_, 0, {});
  EXPECT_THROW(other.command({}), GoalRefused);
  other.stop();
  ASSERT_FALSE(outcomeWithin(1.1));
  EXPECT_NEAR(position(0), 1, 1e-3);
}

TEST_F(TrajectoryControllerTest, AStoppedControllerRefusesAndAStartHolds) {
  make();
  controller_->command(path({{1, {1, 1}}}));
  ASSERT_FALSE(outcomeWithin(0.5));
  const double at_stop = desired(0);
  controller_->stop();
  ASSERT_FALSE(outcomeWithin(0.2));
  EXPECT_EQ(desired(0), at_stop);
  EXPECT_EQ(refusalOf(goalOf(path({{1, {0, 0}}}))), GoalError::INVALID_GOAL);
  EXPECT_THROW(controller_->command({}), InputError);
  EXPECT_THROW(controller_->query(simulator_.time()), InputError);
  controller_->start();
  EXPECT_EQ(desired(0), position(0));
}

TEST_F(TrajectoryControllerTest, QueriesTellThePathAndNotThePast) {
  make();
  stepFor(&simulator_, 0.5);
  controller_->command(path({{1, {1, 1}}}));
  EXPECT_NEAR(controller_->query(2)[0].position, 1, 1e-12);
  EXPECT_NEAR(controller_->query(1.001)[0].position, 0.5, 1e-12);
  EXPECT_EQ(controller_->query(simulator_.time())[1].position, desired(1));
  EXPECT_TRUE(isOneLineWith(refusal([&] { controller_->query(0.3); }), {"0.3 s", "0.5 s"}));
}

TEST_F(TrajectoryControllerTest, OfARobotThatWasRemovedSaysSo) {
  make();
  controller_->accept(goalOf(path({{1, {1, 1}}})));
  simulator_.removeModel(simulator_.robots()[0].name);
  simulator_.step();
  EXPECT_TRUE(isOneLineWith(refusal([&] { controller_->update(); }), {"controller", "was removed"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { controller_->state(); }), {"was removed"}));
}

TEST_F(TrajectoryControllerTest, HalfATurnGoesTheWayOfTheNumbers) {
  make();
  const auto spinTo = [&](double target) {
    controller_->command(path({{0.3, {0, target}}}));
    stepFor(&simulator_, 0.4);
    return position(1);
  };
  EXPECT_NEAR(spinTo(-M_PI / 2), -M_PI / 2, 1e-3);
  EXPECT_NEAR(spinTo(M_PI / 2), M_PI / 2, 1e-3);
  EXPECT_NEAR(spinTo(-M_PI / 2), -M_PI / 2, 1e-3);
  EXPECT_NEAR(spinTo(M_PI / 2 - 0.01), M_PI / 2 - 0.01, 1e-3);
  EXPECT_NEAR(spinTo(-M_PI / 2 - 0.02), 3 * M_PI / 2 - 0.02, 1e-3);
}

}  // namespace
}  // namespace blem_sim::sim
