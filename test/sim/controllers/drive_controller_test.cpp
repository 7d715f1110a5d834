#include "blem_sim/sim/drive_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "blem_sim/sim/state_file.h"
#include "sim/controllers/rover.h"
#include "support/input_errors.h"
#include "support/input_notes.h"

namespace blem_sim::sim {
namespace {

constexpr double ACCELERATION = 1;  // [m/s^2] of rims

ControllerConfig driveConfig() {
  ControllerConfig config;
  config.name = "drive";
  config.kind = ControllerKind::DRIVE;
  config.joints = {"left_axle", "right_axle"};
  config.drive.left = {"left_axle"};
  config.drive.right = {"right_axle"};
  config.drive.wheel_separation = ROVER_SEPARATION;
  config.drive.wheel_radius = ROVER_WHEEL;
  config.drive.wheel_acceleration = ACCELERATION;
  config.drive.cmd_vel_timeout = 0;
  return config;
}

/** Pose on the plane. */
struct Stand {
  double x, y, heading;
};

Stand placeOf(const Pose& X) { return {X.translation().x(), X.translation().y(), std::atan2(X.linear()(1, 0), X.linear()(0, 0))}; }

void expectStand(const Stand& place, const Stand& expected, double distance, double angle) {
  EXPECT_NEAR(place.x, expected.x, distance);
  EXPECT_NEAR(place.y, expected.y, distance);
  EXPECT_NEAR(std::remainder(place.heading - expected.heading, 2 * M_PI), 0, angle);
}

class DriveControllerTest : public testing::Test {
 protected:
  void SetUp() override { drive_.start(); }

  void runFor(double seconds) {
    const long steps = std::lround(seconds / simulator_.config().time_step);
    for (long i = 0; i < steps; ++i) {
      simulator_.step();
      drive_.update();
    }
  }
  Stand truth() const { return placeOf(bodyOf(simulator_, "rover").X_WB); }
  Stand told() const { return placeOf(drive_.odometry().X_OB); }
  double wheelSpeed(int joint) const { return simulator_.report().joints[joint].velocity; }

  Simulator simulator_{roverScene(), model::UriResolver()};
  DriveController drive_{&simulator_, 0, driveConfig()};
};

/** [m] that a rim goes in a time, its speed at the end of a step being that of the ramp then. */
double wayOfRim(double speed, double seconds, double dt) {
  const double ramp = std::abs(speed) / ACCELERATION;
  return std::copysign(ACCELERATION * ramp * (ramp + dt) / 2 + std::abs(speed) * (seconds - ramp), speed);
}

TEST_F(DriveControllerTest, DrivesStraight) {
  drive_.command({0.5, 0});
  runFor(2);
  const double way = wayOfRim(0.5, 2, simulator_.config().time_step);
  expectStand(told(), {way, 0, 0}, 1e-7, 1e-7);
  expectStand(truth(), {way, 0, 0}, 1e-5, 1e-5);
  EXPECT_NEAR(drive_.odometry().v_OB.x(), 0.5, 1e-6);
  EXPECT_NEAR(wheelSpeed(0), 0.5 / ROVER_WHEEL, 1e-5);
}

TEST_F(DriveControllerTest, TurnsInPlaceToTheLeft) {
  drive_.command({0, 1});
  runFor(2);
  const double heading = 2 * wayOfRim(0.5 * ROVER_SEPARATION, 2, simulator_.config().time_step) / ROVER_SEPARATION;
  expectStand(told(), {0, 0, heading}, 1e-7, 1e-6);
  expectStand(truth(), {0, 0, heading}, 1e-5, 1e-4);
  EXPECT_NEAR(drive_.odometry().w_OB.z(), 1, 1e-5);
  EXPECT_LT(wheelSpeed(0), 0);
  EXPECT_GT(wheelSpeed(1), 0);
}

TEST_F(DriveControllerTest, DrivesACircle) {
  drive_.command({0.5, 0.8});
  runFor(1);
  const Stand start = truth(), start_told = told();
  constexpr double TIME = 4, RADIUS = 0.5 / 0.8;
  runFor(TIME);
  const auto after = [&](const Stand& from) {
    const double heading = from.heading + 0.8 * TIME;
    return Stand{from.x + RADIUS * (std::sin(heading) - std::sin(from.heading)),
                 from.y - RADIUS * (std::cos(heading) - std::cos(from.heading)), heading};
  };
  expectStand(told(), after(start_told), 1e-6, 1e-6);
  expectStand(truth(), after(start), 1e-4, 1e-4);
  expectStand(told(), truth(), 1e-3, 1e-3);
}

TEST_F(DriveControllerTest, WheelsSpeedUpAsTheAccelerationLetsThem) {
  drive_.command({0.5, 0});
  for (int i = 1; i <= 100; ++i) {
    runFor(0.001);
    ASSERT_NEAR(wheelSpeed(0), ACCELERATION * 0.001 * i / ROVER_WHEEL, 1e-4) << i;
  }
  drive_.command({-0.5, 0});
  runFor(0.05);
  EXPECT_NEAR(wheelSpeed(0), 0.05 * ACCELERATION / ROVER_WHEEL, 1e-4) << "from what it was, not from rest";
}

TEST_F(DriveControllerTest, TwistsChangeWithinTheirLimits) {
  ControllerConfig settings = driveConfig();
  settings.drive.wheel_acceleration = 0;
  settings.drive.linear = {-0.2, 0.4, -2, 1, -SpeedLimits::NONE, SpeedLimits::NONE};
  settings.drive.angular = {-1, 1, -0.5, 0.5, -SpeedLimits::NONE, SpeedLimits::NONE};
  drive_ = DriveController(&simulator_, 0, settings);
  drive_.start();
  const auto expectTwist = [&](double linear, double angular) {
    EXPECT_NEAR(drive_.odometry().v_OB.x(), linear, 1e-5);
    EXPECT_NEAR(drive_.odometry().w_OB.z(), angular, 1e-4);
  };
  drive_.command({3, 0.2});
  drive_.command({3, 0.2});
  runFor(0.3);
  expectTwist(0.3, 0.15);
  runFor(0.3);
  expectTwist(0.4, 0.2);
  drive_.command({-1, 0.2});
  runFor(0.25);
  expectTwist(-0.1, 0.2);
  const SimulationState state = simulator_.save();
  runFor(0.2);
  expectTwist(-0.2, 0.2);
  const std::uint64_t hash = simulator_.stateHash();
  simulator_.restore(state);
  drive_.update();
  runFor(0.2);
  EXPECT_EQ(simulator_.stateHash(), hash) << "the change goes on where it was saved";
  drive_.stop();
  runFor(0.05);
  expectTwist(0, 0);
}

TEST_F(DriveControllerTest, ACommandsEndKeepsTheLimits) {
  ControllerConfig settings = driveConfig();
  settings.drive.wheel_acceleration = 0;
  settings.drive.cmd_vel_timeout = 0.2;
  settings.drive.linear.min_acceleration = -1;
  drive_ = DriveController(&simulator_, 0, settings);
  drive_.start();
  drive_.command({0.3, 0});
  runFor(0.3);
  EXPECT_NEAR(drive_.odometry().v_OB.x(), 0.2, 1e-3);
  runFor(0.3);
  EXPECT_NEAR(drive_.odometry().v_OB.x(), 0, 1e-5);
}

TEST(DriveController, WheelsAreNoStrongerThanTheirTorque) {
  SimulationConfig config = roverScene();
  config.environments.clear();
  config.robots[0].fixed_base = true;
  Simulator simulator(config, model::UriResolver());
  ControllerConfig settings = driveConfig();
  settings.drive.wheel_acceleration = 0;
  settings.drive.wheel_torque = 0.05;
  DriveController drive(&simulator, 0, settings);
  drive.start();
  drive.command({1, 0});
  stepFor(&simulator, 0.1);
  EXPECT_NEAR(simulator.report().joints[0].velocity, 0.05 * 0.1 / ROVER_WHEEL_INERTIA, 1e-6);
  EXPECT_NEAR(simulator.report().joints[0].effort, 0.05, 1e-6);
  stepFor(&simulator, 0.4);
  EXPECT_NEAR(simulator.report().joints[0].velocity, 1 / ROVER_WHEEL, 1e-6);
}

TEST(DriveController, TellsTheTruthWhereItsOdometryIsTheWorlds) {
  Simulator simulator(roverScene(), model::UriResolver());
  ControllerConfig settings = driveConfig();
  settings.drive.source = DriveConfig::Odometry::WORLD;
  settings.drive.wheel_radius = 0.5 * ROVER_WHEEL;  // a wrong one shows in an encoder's
  DriveController drive(&simulator, 0, settings);
  drive.start();
  drive.command({0.2, 0.3});
  for (int i = 0; i < 1500; ++i) {
    simulator.step();
    drive.update();
  }
  const DriveOdometry odometry = drive.odometry();
  EXPECT_TRUE(odometry.X_OB.isApprox(bodyOf(simulator, "rover").X_WB, 1e-12));
  EXPECT_NEAR(odometry.v_OB.x(), 0.4, 1e-5);
  EXPECT_NEAR(odometry.v_OB.y(), 0, 3e-4);
  EXPECT_NEAR(odometry.w_OB.z(), 0.6, 1e-4);
}

TEST(DriveController, AllWheelsOfASideTurnAlike) {
  std::string rear;
  for (const char* side : {"left", "right"})
    rear += fmt::format(R"(<link name="{0}_rear_wheel"><inertial><mass value="0.5"/><inertia ixx="0.002" iyy="0.002" izz="0.002" ixy="0"
      ixz="0" iyz="0"/></inertial></link><joint name="{0}_rear" type="continuous"><parent link="base_link"/><child link="{0}_rear_wheel"/>
      <axis xyz="0 1 0"/></joint>)",
                        side);
  SimulationConfig config = roverScene(rear);
  config.environments.clear();
  config.robots[0].fixed_base = true;
  Simulator simulator(config, model::UriResolver());
  ControllerConfig settings = driveConfig();
  settings.drive.left = {"left_axle", "left_rear"};
  settings.drive.right = {"right_axle", "right_rear"};
  settings.joints = {"left_axle", "left_rear", "right_axle", "right_rear"};
  DriveController drive(&simulator, 0, settings);
  drive.start();
  drive.command({0.3, 1});
  stepFor(&simulator, 1);
  for (std::size_t joint = 0; joint < 4; ++joint) {
    const bool is_left = simulator.robots()[0].joint_names[joint].front() == 'l';
    EXPECT_NEAR(simulator.report().joints[joint].velocity, (is_left ? 0.1 : 0.5) / ROVER_WHEEL, 1e-6);
  }
  EXPECT_NEAR(drive.odometry().v_OB.x(), 0.3, 1e-6);
  EXPECT_NEAR(drive.odometry().w_OB.z(), 1, 1e-6);
}

TEST_F(DriveControllerTest, ACommandEndsAtItsAge) {
  ControllerConfig settings = driveConfig();
  settings.drive.cmd_vel_timeout = 0.2;
  drive_ = DriveController(&simulator_, 0, settings);
  drive_.start();
  drive_.command({0.1, 0});
  runFor(0.2);
  EXPECT_NEAR(wheelSpeed(0), 0.1 / ROVER_WHEEL, 1e-5);
  runFor(0.2);
  EXPECT_NEAR(wheelSpeed(0), 0, 1e-5);
}

TEST_F(DriveControllerTest, RefusesWhatItCannotDo) {
  drive_.command({0.2, 0});
  for (const DriveTwist& twist : {DriveTwist{NAN, 0}, DriveTwist{0, std::numeric_limits<double>::infinity()}, DriveTwist{1e8, 0}})
    EXPECT_TRUE(isOneLineWith(refusal([&] { drive_.command(twist); }), {"twist: ", "finite number"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { drive_.command({9e6, 0}); }), {"velocity", "left_axle"}));
  runFor(1);
  EXPECT_NEAR(wheelSpeed(0), 0.2 / ROVER_WHEEL, 1e-5) << "the command before goes on";
  drive_.stop();
  runFor(0.5);
  EXPECT_NEAR(wheelSpeed(0), 0, 1e-5);
  EXPECT_TRUE(isOneLineWith(refusal([&] { drive_.command({0.1, 0}); }), {"'drive'", "stopped"}));
}

TEST_F(DriveControllerTest, RefusesJointsThatCannotBeDriven) {
  const auto told_of = [&](const std::string& left, const std::string& right) {
    ControllerConfig settings = driveConfig();
    settings.drive.left = {left};
    settings.drive.right = {right};
    settings.joints = {left, right};
    return refusal([&] { DriveController(&simulator_, 0, settings); });
  };
  EXPECT_TRUE(isOneLineWith(told_of("left_axel", "right_axle"), {"'drive'", "left_axel", "'left_axle'"}));
  EXPECT_TRUE(isOneLineWith(told_of("mount", "right_axle"), {"'drive'", "mount", "movable joint"}));
  EXPECT_TRUE(isOneLineWith(told_of("left_axle", "left_axle"), {"'drive'", "left_axle", "twice"}));
}

TEST_F(DriveControllerTest, TheUrdfHasMeasuresThatAreNotGiven) {
  ControllerConfig settings = driveConfig();
  settings.drive.wheel_separation = settings.drive.wheel_radius = 0;
  settings.drive.separation_multiplier = 1.5;
  settings.drive.radius_multiplier = 2;
  const DriveController drive(&simulator_, 0, settings);
  EXPECT_NEAR(drive.config().drive.wheel_separation, 1.5 * ROVER_SEPARATION, 1e-15);
  EXPECT_EQ(drive.config().drive.wheel_radius, 2 * ROVER_WHEEL);
}

TEST(DriveController, SaysWhichMeasureTheUrdfHasNot) {
  SimulationConfig config = roverScene();
  std::string& urdf = config.robots[0].urdf_xml;
  for (const auto& [from, to] :
       {std::make_pair("<sphere radius=\"0.1\"/>", "<box size=\"0.1 0.1 0.1\"/>"), std::make_pair("0 -0.2 0", "0 0.2 0")})
    for (auto at = urdf.find(from); at != std::string::npos; at = urdf.find(from)) urdf.replace(at, std::string(from).size(), to);
  Simulator simulator(config, model::UriResolver());
  ControllerConfig settings = driveConfig();
  settings.drive.wheel_radius = 0;
  EXPECT_TRUE(isOneLineWith(refusal([&] { DriveController(&simulator, 0, settings); }), {"wheel_radius", "left_wheel", "<cylinder>"}));
  settings = driveConfig();
  settings.drive.wheel_separation = 0;
  EXPECT_TRUE(isOneLineWith(refusal([&] { DriveController(&simulator, 0, settings); }), {"wheel_separation", "left_axle", "one place"}));
}

TEST_F(DriveControllerTest, WheelsThatWereResetAreItsAgain) {
  drive_.command({0.5, 0.2});
  runFor(1);
  simulator_.resetWorld();
  runFor(0.5);
  expectStand(truth(), {0, 0, 0}, 1e-6, 1e-6);
  expectStand(told(), {0, 0, 0}, 1e-6, 1e-6);
  drive_.command({0.5, 0});
  runFor(1);
  EXPECT_GT(told().x, 0.3);
}

TEST_F(DriveControllerTest, GoesOnFromASavedStateInTheMiddleOfARamp) {
  drive_.command({0.5, 0.4});
  runFor(0.2);
  const SimulationState state = stateOf(stateBytes(simulator_.save()), "bytes");
  const Stand saved = told();
  runFor(0.5);
  const std::uint64_t hash = simulator_.stateHash();
  const Stand before = told();
  simulator_.restore(state);
  drive_.update();
  expectStand(told(), saved, 0, 0);
  runFor(0.5);
  EXPECT_EQ(simulator_.stateHash(), hash);
  expectStand(told(), before, 0, 0);
  Simulator fresh(roverScene(), model::UriResolver());
  fresh.restore(state);
  stepFor(&fresh, 0.5);
  EXPECT_EQ(fresh.stateHash(), hash) << "the ramp is part of the state";
}

TEST_F(DriveControllerTest, ARestoredCommandEndsAtItsAge) {
  ControllerConfig settings = driveConfig();
  settings.drive.cmd_vel_timeout = 0.2;
  settings.drive.wheel_acceleration = 0;
  drive_ = DriveController(&simulator_, 0, settings);
  drive_.start();
  drive_.command({0.1, 0});
  runFor(0.1);
  const SimulationState state = simulator_.save();
  runFor(0.3);
  ASSERT_NEAR(wheelSpeed(0), 0, 1e-5);
  Simulator fresh(roverScene(), model::UriResolver());
  for (Simulator* simulator : {&simulator_, &fresh}) {
    DriveController drive(simulator, 0, settings);
    drive.start();
    simulator->restore(state);
    for (int i = 0; i < 100; ++i) {
      simulator->step();
      drive.update();
    }
    EXPECT_NEAR(simulator->report().joints[0].velocity, 0.1 / ROVER_WHEEL, 1e-5);
    simulator->step();
    EXPECT_NEAR(simulator->report().joints[0].velocity, 0, 1e-5);
  }
}

TEST_F(DriveControllerTest, AStateThatWasSavedWithoutItHasItsCommandsEnd) {
  drive_.command({0.1, 0});
  runFor(0.5);
  SimulationState state = simulator_.save();
  state.memories.clear();
  EXPECT_TRUE(isOneLineWith(refusal([&] { simulator_.restore(state); }), {"cut short"})) << "the header knows of it";
  drive_.stop();
  drive_.start();
  simulator_.driveJoints(0, {{"left_axle", "right_axle"}, {1, 1}, 0, 0});
  simulator_.remember("rover", "drive", {});
  state = simulator_.save();
  ControllerConfig settings = driveConfig();
  settings.drive.cmd_vel_timeout = 0.2;
  drive_ = DriveController(&simulator_, 0, settings);
  drive_.start();
  simulator_.restore(state);
  runFor(0.1);
  EXPECT_NEAR(wheelSpeed(0), 1, 1e-4);
  EXPECT_NEAR(told().x, 0.01, 2e-4);
  runFor(0.3);
  EXPECT_NEAR(wheelSpeed(0), 0, 1e-5);
}

TEST_F(DriveControllerTest, ARobotThatIsRemovedLeavesNoMemory) {
  drive_.command({0.1, 0});
  EXPECT_FALSE(simulator_.save().memories["rover"].empty());
  simulator_.removeModel("rover");
  EXPECT_TRUE(simulator_.save().memories.empty());
}

TEST(DriveController, ARecordOfItPlayedAgainGivesTheSameBits) {
  Simulator simulator(roverScene(), model::UriResolver());
  InputNotes notes(&simulator);
  DriveController drive(&simulator, 0, driveConfig());
  drive.start();
  for (const DriveTwist& twist : {DriveTwist{0.5, 0.3}, DriveTwist{-0.2, 0.3}, DriveTwist{0, 0}}) {
    drive.command(twist);
    for (int i = 0; i < 100; ++i) {
      simulator.step();
      drive.update();
    }
  }
  EXPECT_EQ(notes.inputs.size(), 4u) << "one for each command, and the start's";
  EXPECT_EQ(firstDifference(roverScene(), notes), 0u);
  notes.inputs[1].second.numbers.back() += 1;
  EXPECT_EQ(firstDifference(roverScene(), notes), 1u) << "a number that is another shows";
}

}  // namespace
}  // namespace blem_sim::sim
