#include "blem_sim/sim/trajectory_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/simulation_scene.h"
#include "support/input_errors.h"

namespace blem_sim {
namespace {

std::string link(const std::string& name) {
  return "<link name='" + name + "'><inertial><origin xyz='0.1 0 0'/><mass value='1'/>" +
         "<inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& child, const std::string& extras = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='base'/><child link='" + child + "'/><axis xyz='0 0 1'/>" +
         "<limit lower='-10' upper='10' effort='1000' velocity='100'/>" + extras + "</joint>";
}

SimulationConfig armScene() {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.robots = {robot("arm",
                         "<robot name='arm'><link name='base'/>" + link("a") + link("b") + link("c") + joint("swing", "revolute", "a") +
                             joint("spin", "continuous", "b") + joint("shadow", "revolute", "c", "<mimic joint='swing'/>") + "</robot>",
                         true)};
  config.robots[0].gains["default"] = {1e6, 0, 1e4};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  return config;
}

/** Points for `swing` and `spin`: {time [s], positions}. */
JointTrajectory path(const std::vector<std::pair<double, std::vector<double>>>& points, double start = 0) {
  JointTrajectory trajectory;
  trajectory.joints = {"swing", "spin"};
  trajectory.start_time = start;
  for (const auto& [time, positions] : points) trajectory.points.push_back({time, positions, {0, 0}, {}, {}});
  return trajectory;
}

TrajectoryGoal goalOf(const JointTrajectory& trajectory) { return {trajectory, {}, {}, 0}; }

class TrajectoryControllerTest : public testing::Test {
 protected:
  void make(const ControllerConfig& config = {}) { controller_ = std::make_unique<TrajectoryController>(&simulator_, 0, config); }

  /** Steps up to the goal's outcome, or for a time. */
  std::optional<GoalOutcome> outcomeWithin(double seconds) {
    for (long i = 0; i < std::lround(seconds / simulator_.config().time_step); ++i) {
      simulator_.step();
      if (const auto outcome = controller_->update()) return outcome;
    }
    return {};
  }

  GoalError refusalOf(const TrajectoryGoal& goal) {
    try {
      controller_->accept(goal);
    } catch (const GoalRefused& refusal) {
      EXPECT_TRUE(isOneLineWith(refusal.what(), {})) << refusal.what();
      return refusal.error;
    }
    return GoalError::SUCCESSFUL;
  }

  double position(int joint) const { return controller_->state()[joint].position; }
  double desired(int joint) const { return controller_->state()[joint].desired.position; }

  Simulator simulator_{armScene(), UriResolver()};
  std::unique_ptr<TrajectoryController> controller_;
};

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

TEST_F(TrajectoryControllerTest, AGoalSucceedsAtItsEnd) {
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

TEST_F(TrajectoryControllerTest, AnEmptyGoalWithNamesStopsAndSucceeds) {
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

TEST_F(TrajectoryControllerTest, AViolatedPathToleranceAbortsTheGoalAndNotTheMotion) {
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

TEST_F(TrajectoryControllerTest, GoalTolerancesWaitForTheGoalTime) {
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

TEST_F(TrajectoryControllerTest, AGoalsTolerancesBeatTheControllers) {
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

TEST_F(TrajectoryControllerTest, AGoalDatedAheadLetsTheOldPathRun) {
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

TEST_F(TrajectoryControllerTest, ACommandEndsAGoal) {
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

TEST_F(TrajectoryControllerTest, CancelHolds) {
  make();
  controller_->accept(goalOf(path({{1, {1, 1}}})));
  ASSERT_FALSE(outcomeWithin(0.5));
  controller_->cancel();
  const double held = position(0);
  EXPECT_FALSE(outcomeWithin(0.6));
  EXPECT_NEAR(position(0), held, 1e-6);
}

TEST_F(TrajectoryControllerTest, OtherCommandsAndResetsEndAGoal) {
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

TEST_F(TrajectoryControllerTest, AStoppedControllerRefusesAndAStartHolds) {
  make();
  controller_->command(path({{1, {1, 1}}}));
  ASSERT_FALSE(outcomeWithin(0.5));
  controller_->stop();
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

TEST_F(TrajectoryControllerTest, ErrorsOfContinuousJointsGoTheShortWayRound) {
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
}  // namespace blem_sim
