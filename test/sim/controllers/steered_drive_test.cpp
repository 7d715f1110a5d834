// Drives that steer: how they turn, beside the closed form, and what their odometry tells.
#include <gtest/gtest.h>

#include <cmath>

#include "blem_sim/sim/drive_controller.h"
#include "sim/controllers/steered_robots.h"
#include "support/input_errors.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

ControllerConfig steeredDrive() {
  ControllerConfig config;
  config.name = "drive";
  config.kind = ControllerKind::STEERED_DRIVE;
  config.drive.cmd_vel_timeout = 0;
  config.drive.wheel_acceleration = 1;
  return config;
}

ControllerConfig carDrive() {
  ControllerConfig config = steeredDrive();
  config.drive.steering.rear = config.drive.steering.driven = {"rear_left_axle", "rear_right_axle"};
  config.drive.steering.joints = {"left_steer", "right_steer"};
  config.joints = jointsOf(config.drive.steering);
  return config;
}

ControllerConfig tricycleDrive() {
  ControllerConfig config = steeredDrive();
  config.drive.steering.rear = {"left_axle", "right_axle"};
  config.drive.steering.joints = {"front_steer"};
  config.drive.steering.driven = {"front_axle"};
  config.joints = jointsOf(config.drive.steering);
  return config;
}

/** A robot whose drive runs. */
struct Driven {
  Driven(const std::string& urdf, const ControllerConfig& config)
      : simulator(steeredScene(urdf, config), model::UriResolver()), drive(&simulator, 0, config) {
    drive.start();
  }
  void runFor(double seconds) {
    const long steps = std::lround(seconds / simulator.config().time_step);
    for (long i = 0; i < steps; ++i) {
      simulator.step();
      drive.update();
    }
  }
  const dynamics::JointState& joint(const std::string& name) const {
    const std::vector<std::string>& names = simulator.robots()[0].joint_names;
    return simulator.report().joints[simulator.robots()[0].joints[std::find(names.begin(), names.end(), name) - names.begin()]];
  }
  /** [m/s] of a rim. */
  double rim(const std::string& wheel) const { return CAR_WHEEL * joint(wheel).velocity; }
  Pose truth() const { return bodyOf(simulator, "car").X_WB; }

  Simulator simulator;
  DriveController drive;
};

double headingOf(const Pose& X) { return std::atan2(X.linear()(1, 0), X.linear()(0, 0)); }

/** Radius [m] of the circle on which a point of the base went meanwhile, from its chord and turn. */
double radiusOf(const Pose& from, const Pose& to, const Vector3& point) {
  const double turned = std::remainder(headingOf(to) - headingOf(from), 2 * M_PI);
  return (to * point - from * point).norm() / (2 * std::sin(std::abs(turned) / 2));
}

const Vector3 REAR_OF_CAR(-CAR_WHEELBASE / 2, 0, 0);

TEST(SteeredDrive, ACarTurnsOnTheCircleOfItsSteeringAngle) {
  Driven car(carUrdf(), carDrive());
  const double speed = 0.5;
  for (const double turn : SANITIZED ? std::vector<double>{-0.5} : std::vector<double>{0.5, -0.5, 0.2}) {
    const double radius = speed / turn, angle = std::atan(CAR_WHEELBASE / radius);
    car.drive.command({speed, turn});
    car.runFor(2);
    const Pose before = car.truth(), told_before = car.drive.odometry().X_OB;
    car.runFor(2);
    EXPECT_NEAR(radiusOf(before, car.truth(), REAR_OF_CAR), CAR_WHEELBASE / std::abs(std::tan(angle)), 0.01 * std::abs(radius)) << turn;
    EXPECT_NEAR(radiusOf(told_before, car.drive.odometry().X_OB, REAR_OF_CAR), std::abs(radius), 1e-3 * std::abs(radius)) << turn;
    EXPECT_NEAR(car.joint("left_steer").position, std::atan(CAR_WHEELBASE / (radius - CAR_TRACK / 2)), 2e-3) << turn;
    EXPECT_NEAR(car.joint("right_steer").position, std::atan(CAR_WHEELBASE / (radius + CAR_TRACK / 2)), 2e-3) << turn;
    EXPECT_NEAR(car.rim("rear_left_axle"), speed - turn * CAR_TRACK / 2, 1e-4) << turn;
    EXPECT_NEAR(car.rim("rear_right_axle"), speed + turn * CAR_TRACK / 2, 1e-4) << turn;
    EXPECT_NEAR(car.rim("left_axle"), std::hypot(radius - CAR_TRACK / 2, CAR_WHEELBASE) * std::abs(turn), 5e-3)
        << "it rolls with the ground";
  }
}

TEST(SteeredDrive, OdometryTellsOfTheBaseWhereverItIs) {
  Driven car(carUrdf(), carDrive());
  for (const DriveTwist& twist : {DriveTwist{0.5, 0.6}, DriveTwist{0.4, -0.3}, DriveTwist{-0.3, 0.3}}) {
    car.drive.command(twist);
    car.runFor(SANITIZED ? 1 : 2);  // all is at its speed after 0.7 s
  }
  const DriveOdometry odometry = car.drive.odometry();
  EXPECT_NEAR((odometry.X_OB.translation() - car.truth().translation()).head<2>().norm(), 0, 0.01);
  EXPECT_NEAR(std::remainder(headingOf(odometry.X_OB) - headingOf(car.truth()), 2 * M_PI), 0, 0.01);
  EXPECT_NEAR(odometry.v_OB.x(), -0.3, 1e-3);
  EXPECT_NEAR(odometry.v_OB.y(), 0.3 * CAR_WHEELBASE / 2, 1e-3);
  EXPECT_NEAR(odometry.w_OB.z(), 0.3, 1e-3);
}

TEST(SteeredDrive, TakesSteeringAnglesInstead) {
  ControllerConfig config = carDrive();
  config.drive.steering.takes_angles = true;
  Driven car(carUrdf(), config);
  car.drive.command({0.4, 0.5});
  car.runFor(1);
  const Pose before = car.truth();
  car.runFor(2);
  const double radius = CAR_WHEELBASE / std::tan(0.5);
  EXPECT_NEAR(radiusOf(before, car.truth(), REAR_OF_CAR), radius, 0.01 * radius);
  EXPECT_NEAR(car.drive.odometry().v_OB.x(), 0.4, 1e-3) << "of the driven axle's middle";
  car.drive.stop();
  car.drive.start();
  EXPECT_EQ(car.drive.odometry().X_OB.translation(), Vector3::Zero());
  car.runFor(1);
  EXPECT_NEAR(car.joint("left_steer").position, 0, 2e-3) << "a start is straight";
  car.drive.command({0.4, 0.2});
  car.runFor(1);
  car.drive.command({0, 0});
  car.runFor(1);
  EXPECT_NEAR(car.joint("left_steer").position, 0, 2e-3);
}

TEST(SteeredDrive, AllWheelsOfACarMayBeDriven) {
  ControllerConfig config = carDrive();
  config.drive.steering.driven = {"right_axle", "rear_left_axle", "left_axle", "rear_right_axle"};
  config.joints = jointsOf(config.drive.steering);
  Driven car(carUrdf(), config);
  car.drive.command({0.5, 0.5});
  car.runFor(2);
  EXPECT_NEAR(car.rim("rear_left_axle"), 0.5 * 0.8, 1e-4);
  EXPECT_NEAR(car.rim("rear_right_axle"), 0.5 * 1.2, 1e-4);
  EXPECT_NEAR(car.rim("left_axle"), 0.5 * std::hypot(0.8, CAR_WHEELBASE), 1e-4);
  EXPECT_NEAR(car.rim("right_axle"), 0.5 * std::hypot(1.2, CAR_WHEELBASE), 1e-4);
  EXPECT_NEAR(car.drive.odometry().w_OB.z(), 0.5, 1e-3);
}

TEST(SteeredDrive, ATricycleIsPulledByItsFrontWheel) {
  Driven tricycle(tricycleUrdf(), tricycleDrive());
  tricycle.drive.command({0.3, 0.4});
  tricycle.runFor(2);
  const Pose before = tricycle.truth();
  tricycle.runFor(2);
  EXPECT_NEAR(radiusOf(before, tricycle.truth(), Vector3::Zero()), 0.75, 0.0075);
  EXPECT_NEAR(tricycle.rim("front_axle"), std::hypot(0.3, 0.4 * CAR_WHEELBASE), 1e-4);
  EXPECT_NEAR(tricycle.rim("left_axle"), 0.3 - 0.4 * CAR_TRACK / 2, 5e-3);
  EXPECT_NEAR(tricycle.drive.odometry().w_OB.z(), 0.4, 4e-3);
  EXPECT_NEAR((tricycle.drive.odometry().X_OB.translation() - tricycle.truth().translation()).head<2>().norm(), 0, 0.01);
}

TEST(SteeredDrive, ATricycleTurnsInPlace) {
  Driven tricycle(tricycleUrdf(), tricycleDrive());
  tricycle.drive.command({0, 0.5});
  tricycle.runFor(1);
  const Pose before = tricycle.truth();
  tricycle.runFor(2);
  EXPECT_NEAR((tricycle.truth().translation() - before.translation()).norm(), 0, 5e-3);
  EXPECT_NEAR(headingOf(tricycle.truth()) - headingOf(before), 1, 0.01);
  EXPECT_NEAR(tricycle.joint("front_steer").position, M_PI / 2, 2e-3);
  EXPECT_NEAR(tricycle.drive.odometry().w_OB.z(), 0.5, 5e-3);
}

/** As Gazebo's plugin: the speed is that of the wheel that pulls. */
TEST(SteeredDrive, ATricycleTakesAnglesAndTheSpeedOfItsFrontWheel) {
  ControllerConfig config = tricycleDrive();
  config.drive.steering.takes_angles = true;
  Driven tricycle(tricycleUrdf(), config);
  tricycle.drive.command({0.4, 0.7});
  tricycle.runFor(2);
  EXPECT_NEAR(tricycle.rim("front_axle"), 0.4, 1e-4);
  EXPECT_NEAR(tricycle.drive.odometry().v_OB.x(), 0.4 * std::cos(0.7), 4e-3);
  EXPECT_NEAR(tricycle.drive.odometry().w_OB.z(), 0.4 * std::sin(0.7) / CAR_WHEELBASE, 8e-3);
}

TEST(SteeredDrive, SteeringHasItsSpeedAndWheelsTheirAcceleration) {
  ControllerConfig config = carDrive();
  config.drive.steering.takes_angles = true;
  config.drive.steering.speed = 0.5;
  Driven car(carUrdf(), config);
  car.drive.command({0.4, 0.6});
  car.runFor(0.2);
  EXPECT_NEAR(car.joint("left_steer").position, std::atan(CAR_WHEELBASE / (CAR_WHEELBASE / std::tan(0.1) - CAR_TRACK / 2)), 0.01)
      << "its motor lags by some 16 ms";
  EXPECT_NEAR(car.rim("rear_left_axle") + car.rim("rear_right_axle"), 2 * 0.2, 1e-3) << "1 m/s^2, together";
  car.runFor(2);
  EXPECT_NEAR(car.drive.odometry().w_OB.z(), 0.4 * std::tan(0.6) / CAR_WHEELBASE, 5e-3);
}

TEST(SteeredDrive, SteersAsFarAsLimitsLetItAndKeepsItsSpeed) {
  ControllerConfig config = carDrive();
  config.drive.steering.max_angle = 0.4;
  Driven car(carUrdf(), config);
  car.drive.command({0.3, 3});
  car.runFor(2);
  EXPECT_NEAR(car.drive.odometry().v_OB.x(), 0.3, 1e-3);
  EXPECT_NEAR(car.drive.odometry().w_OB.z(), 0.3 * std::tan(0.4) / CAR_WHEELBASE, 2e-3);
  car.drive.command({0, 1});
  car.runFor(1);
  EXPECT_NEAR(car.drive.odometry().w_OB.z(), 0, 1e-4) << "it cannot turn in place";
  Driven bounded(carUrdf(), carDrive());
  bounded.drive.command({0.2, 3});
  bounded.runFor(2);
  EXPECT_NEAR(bounded.joint("left_steer").position, 1.2, 2e-3) << "the inner wheel's limit";
}

TEST(SteeredDrive, SteeringStaysWhereACommandEnds) {
  ControllerConfig config = carDrive();
  config.drive.angular.min_acceleration = -0.5;
  Driven car(carUrdf(), config);
  car.drive.command({0.5, 0.5});
  car.runFor(1);
  const double angle = car.joint("left_steer").position;
  car.drive.command({0, 0});
  car.runFor(0.3);
  EXPECT_NEAR(car.joint("left_steer").position, angle, 2e-3) << "while it slows down";
  car.runFor(0.7);
  EXPECT_NEAR(car.drive.odometry().v_OB.norm(), 0, 1e-3);
  EXPECT_NEAR(car.joint("left_steer").position, angle, 2e-3);
}

TEST(SteeredDrive, GoesOnFromASavedStateInTheMiddleOfARamp) {
  ControllerConfig config = carDrive();
  config.drive.steering.speed = 1;
  Driven car(carUrdf(), config);
  car.drive.command({0.5, 0.8});
  car.runFor(0.2);
  const SimulationState state = car.simulator.save();
  car.runFor(0.5);
  const std::uint64_t hash = car.simulator.stateHash();
  const Pose told = car.drive.odometry().X_OB;
  car.simulator.restore(state);
  car.drive.update();
  car.runFor(0.5);
  EXPECT_EQ(car.simulator.stateHash(), hash);
  EXPECT_TRUE(car.drive.odometry().X_OB.isApprox(told, 0));
}

TEST(SteeredDrive, ItsJointsHaveTheMotorsThatTheyNeed) {
  SimulationConfig config = steeredScene(carUrdf(), carDrive());
  config.robots[0].motors = MotorDefault::FREE;
  Simulator simulator(config, model::UriResolver());
  DriveController drive(&simulator, 0, carDrive());
  drive.start();
  drive.command({0, 1});
  stepFor(&simulator, 1);
  const std::vector<std::string>& names = simulator.robots()[0].joint_names;
  const int steer = static_cast<int>(std::find(names.begin(), names.end(), "left_steer") - names.begin());
  EXPECT_NEAR(simulator.report().joints[simulator.robots()[0].joints[steer]].position, 1.2, 2e-3) << "a motor though motors are free";
}

TEST(SteeredDrive, RefusesWhatCannotBeOne) {
  Simulator simulator(steeredScene(tricycleUrdf(), tricycleDrive()), model::UriResolver());
  const auto told = [&](const std::vector<std::string>& rear, const std::string& steer, const std::string& driven) {
    ControllerConfig config = steeredDrive();
    config.drive.steering.rear = rear;
    config.drive.steering.joints = {steer};
    config.drive.steering.driven = {driven};
    config.joints = jointsOf(config.drive.steering);
    return refusal([&] { DriveController(&simulator, 0, config); });
  };
  EXPECT_TRUE(isOneLineWith(told({}, "front_steer", "front_axle"), {"'drive'", "rear_wheel", "front_steer"}));
  EXPECT_TRUE(isOneLineWith(told({"left_axle"}, "front_stear", "front_axle"), {"front_stear", "'front_steer'"}));
  EXPECT_TRUE(isOneLineWith(told({"front_axle"}, "front_steer", "front_axle"), {"rear_wheel", "front_axle", "not steered"}));
  EXPECT_TRUE(isOneLineWith(told({"left_axle"}, "front_steer", "right_axle"), {"driven_wheel", "right_axle", "front_steer"}));
  EXPECT_TRUE(isOneLineWith(told({"left_axle", "left_axle"}, "front_steer", "front_axle"), {"left_axle", "twice"}));
  EXPECT_TRUE(isOneLineWith(told({"left_axle"}, "right_axle", "left_axle"), {"wheel_separation_h", "metres"}));
  DriveController drive(&simulator, 0, tricycleDrive());
  drive.start();
  EXPECT_TRUE(isOneLineWith(refusal([&] { drive.command({9e6, 0}); }), {"velocity", "front_axle"}));
}

}  // namespace
}  // namespace blem_sim::sim
