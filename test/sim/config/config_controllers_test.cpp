#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "blem_sim/sim/config.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

std::optional<std::vector<ControllerConfig>> controllersOf(const std::string& yaml) {
  return parseConfig(YAML::Load("robots: [{name: r, urdf: r.urdf" + yaml + "}]"), "test", "").robots[0].controllers;
}

std::string refusalOfList(const std::string& list) {
  return refusal([&] { controllersOf(", controllers: [" + list + "]"); });
}

TEST(ConfigControllers, NoneGivenIsNotAnEmptyList) {
  EXPECT_FALSE(controllersOf(""));
  ASSERT_TRUE(controllersOf(", controllers: []"));
  EXPECT_TRUE(controllersOf(", controllers: []")->empty());
}

TEST(ConfigControllers, ReadsTrajectoryControllers) {
  const auto controllers = controllersOf(
      ", controllers: [{name: arm, joints: [a, b], state_publish_rate: 10, action_monitor_rate: 5, stop_trajectory_duration: 0.5, "
      "allow_partial_joints_goal: true, constraints: {goal_time: 2, stopped_velocity_tolerance: 0.3, a: {goal: 0.1, trajectory: 0.2}}}]");
  ASSERT_EQ(controllers->size(), 1u);
  const ControllerConfig& arm = controllers->front();
  EXPECT_EQ(arm.name, "arm");
  EXPECT_EQ(arm.kind, ControllerKind::TRAJECTORY);
  EXPECT_EQ(arm.joints, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(arm.state_publish_rate, 10);
  EXPECT_EQ(arm.action_monitor_rate, 5);
  EXPECT_EQ(arm.stop_trajectory_duration, 0.5);
  EXPECT_TRUE(arm.allow_partial_joints_goal);
  EXPECT_EQ(arm.goal_time, 2);
  EXPECT_EQ(arm.stopped_velocity_tolerance, 0.3);
  EXPECT_EQ(arm.joint_constraints.at("a").goal, 0.1);
  EXPECT_EQ(arm.joint_constraints.at("a").trajectory, 0.2);
  EXPECT_EQ(arm.joint_constraints.size(), 1u);
}

TEST(ConfigControllers, ReadsGrippers) {
  const ControllerConfig gripper =
      controllersOf(
          ", controllers: [{name: g, type: gripper, joint: f, goal_tolerance: 0.2, stall_velocity_threshold: 0.3, stall_timeout: 4}]")
          ->front();
  EXPECT_EQ(gripper.kind, ControllerKind::GRIPPER);
  EXPECT_EQ(gripper.joints, std::vector<std::string>{"f"});
  EXPECT_EQ(gripper.goal_tolerance, 0.2);
  EXPECT_EQ(gripper.stall_velocity_threshold, 0.3);
  EXPECT_EQ(gripper.stall_timeout, 4);
}

TEST(ConfigControllers, ReadsDrives) {
  const ControllerConfig config =
      controllersOf(
          ", controllers: [{name: d, type: diff_drive, left_wheel: [a, b], right_wheel: c, wheel_separation: 0.5, wheel_radius: 0.1, "
          "wheel_separation_multiplier: 2, wheel_radius_multiplier: 0.5, wheel_acceleration: 2, wheel_torque: 3, cmd_vel_timeout: 0.7, "
          "cmd_vel_topic: go, odom_topic: way, odom_frame_id: o, "
          "base_frame_id: base, publish_rate: off, enable_odom_tf: false, odometry_source: world, "
          "pose_covariance_diagonal: [1, 2, 3, 4, 5, 6], twist_covariance_diagonal: [6, 5, 4, 3, 2, 1]}]")
          ->front();
  EXPECT_EQ(config.kind, ControllerKind::DRIVE);
  EXPECT_EQ(config.joints, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(config.drive.left, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(config.drive.right, std::vector<std::string>{"c"});
  EXPECT_EQ(config.drive.wheel_separation, 0.5);
  EXPECT_EQ(config.drive.wheel_radius, 0.1);
  EXPECT_EQ(config.drive.separation_multiplier, 2);
  EXPECT_EQ(config.drive.radius_multiplier, 0.5);
  EXPECT_EQ(config.drive.wheel_acceleration, 2);
  EXPECT_EQ(config.drive.wheel_torque, 3);
  EXPECT_EQ(config.drive.cmd_vel_timeout, 0.7);
  EXPECT_EQ(commandTopic(config), "go");
  EXPECT_EQ(odometryTopic(config), "way");
  EXPECT_EQ(config.drive.odom_frame, "o");
  EXPECT_EQ(config.drive.base_frame, "base");
  EXPECT_EQ(config.drive.publish_rate, RATE_OFF);
  EXPECT_FALSE(config.drive.enable_odom_tf);
  EXPECT_EQ(config.drive.source, DriveConfig::Odometry::WORLD);
  EXPECT_EQ(config.drive.pose_covariance[1], 2);
  EXPECT_EQ(config.drive.twist_covariance[1], 5);
}

TEST(ConfigControllers, ReadsLimitsOfTwists) {
  const DriveConfig drive =
      controllersOf(
          ", controllers: [{name: d, type: diff_drive, left_wheel: a, right_wheel: b, "
          "linear: {x: {has_velocity_limits: true, max_velocity: 1, min_velocity: -0.5, has_acceleration_limits: true, "
          "max_acceleration: 3}}, "
          "angular: {z: {has_velocity_limits: false, max_velocity: 2, has_jerk_limits: true, max_jerk: 20, min_jerk: -40}}}]")
          ->front()
          .drive;
  EXPECT_EQ(drive.linear.max_velocity, 1);
  EXPECT_EQ(drive.linear.min_velocity, -0.5);
  EXPECT_EQ(drive.linear.max_acceleration, 3);
  EXPECT_EQ(drive.linear.min_acceleration, -3) << "left out";
  EXPECT_EQ(drive.linear.max_jerk, SpeedLimits::NONE);
  EXPECT_EQ(drive.angular.max_velocity, SpeedLimits::NONE) << "switched off";
  EXPECT_EQ(drive.angular.max_jerk, 20);
  EXPECT_EQ(drive.angular.min_jerk, -40);
}

TEST(ConfigControllers, RefusesFaultyLimitsOfTwists) {
  const auto told = [](const std::string& limits) {
    return refusalOfList("{name: d, type: diff_drive, left_wheel: a, right_wheel: b, linear: {x: {" + limits + "}}}");
  };
  EXPECT_EQ(told("has_velocity_limits: false"), "");
  EXPECT_TRUE(isOneLineWith(told("has_velocity_limits: true"), {"linear.x.max_velocity", "missing", "false"}));
  EXPECT_TRUE(isOneLineWith(told("max_velocity: -1"), {"linear.x.max_velocity", "at least 0"}));
  EXPECT_TRUE(isOneLineWith(told("min_acceleration: 1"), {"linear.x.min_acceleration", "at most 0"}));
  EXPECT_TRUE(isOneLineWith(told("max_speed: 1"), {"max_speed", "unknown"}));
}

TEST(ConfigControllers, RefusesFaultyDrives) {
  const std::string wheels = "name: d, type: diff_drive, left_wheel: a, right_wheel: b";
  const auto told = [](const std::string& drive) { return refusalOfList("{" + drive + "}"); };
  EXPECT_TRUE(isOneLineWith(told("name: d, type: diff_drive, right_wheel: b"), {"left_wheel", "missing"}));
  EXPECT_TRUE(isOneLineWith(told("name: d, type: diff_drive, left_wheel: []"), {"left_wheel", "list"}));
  EXPECT_EQ(told(wheels), "") << "the URDF has their measures";
  EXPECT_TRUE(isOneLineWith(told(wheels + ", wheel_radius_multiplier: 0"), {"wheel_radius_multiplier", "above 0"}));
  EXPECT_TRUE(isOneLineWith(told(wheels + ", wheel_separation: 0, wheel_radius: 0.1"), {"wheel_separation", "above 0"}));
  const std::string whole = wheels + ", wheel_separation: 0.4, wheel_radius: 0.1";
  EXPECT_TRUE(isOneLineWith(told(whole + ", odometry_source: stars"), {"odometry_source", "encoder"}));
  EXPECT_TRUE(isOneLineWith(told(whole + ", pose_covariance_diagonal: [1, 2, 3, 4, 5, -6]"), {"pose_covariance_diagonal", "below 0"}));
  EXPECT_TRUE(isOneLineWith(told(whole + ", wheel_diameter: 0.2"), {"wheel_diameter", "wheel_radius"}));
  EXPECT_EQ(told(whole), "");
}

TEST(ConfigControllers, ReadsDrivesThatSteer) {
  const auto read = [](const std::string& more) {
    return controllersOf(", controllers: [{name: d, type: steered_drive, rear_wheel: [a, b], front_steer: s" + more + "}]").value().front();
  };
  ControllerConfig config = read(
      ", driven_wheel: f, wheel_separation_h: 0.7, wheel_separation_h_multiplier: 1.1, front_wheel_radius: 0.2, wheel_radius: 0.1, "
      "max_steering_angle: 0.6, steering_speed: 2, cmd_angle_instead_rotvel: true, cmd_vel_timeout: 3");
  EXPECT_EQ(config.kind, ControllerKind::STEERED_DRIVE);
  EXPECT_EQ(config.joints, (std::vector<std::string>{"a", "b", "s", "f"}));
  const SteeringConfig& steering = config.drive.steering;
  EXPECT_EQ(steering.rear, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(steering.joints, std::vector<std::string>{"s"});
  EXPECT_EQ(steering.driven, std::vector<std::string>{"f"});
  EXPECT_EQ(steering.wheelbase, 0.7);
  EXPECT_EQ(steering.wheelbase_multiplier, 1.1);
  EXPECT_EQ(steering.steered_radius, 0.2);
  EXPECT_EQ(config.drive.wheel_radius, 0.1);
  EXPECT_EQ(steering.max_angle, 0.6);
  EXPECT_EQ(steering.speed, 2);
  EXPECT_TRUE(steering.takes_angles);
  EXPECT_EQ(config.drive.cmd_vel_timeout, 3);
  config = read("");
  EXPECT_EQ(config.drive.steering.driven, (std::vector<std::string>{"a", "b"})) << "left out";
  EXPECT_EQ(config.joints, (std::vector<std::string>{"a", "b", "s"}));
}

TEST(ConfigControllers, ReadsDrivesWithoutWheels) {
  const auto list = [](const std::string& more) { return ", controllers: [{name: d, type: planar_drive" + more + "}]"; };
  const ControllerConfig config =
      controllersOf(list(", max_force: 50, max_torque: 7, cmd_vel_timeout: 3, linear: {y: {has_velocity_limits: true, max_velocity: 2}}"))
          .value()
          .front();
  EXPECT_EQ(config.kind, ControllerKind::PLANAR_DRIVE);
  EXPECT_TRUE(config.joints.empty());
  EXPECT_EQ(config.drive.max_force, 50);
  EXPECT_EQ(config.drive.max_torque, 7);
  EXPECT_EQ(config.drive.cmd_vel_timeout, 3);
  EXPECT_EQ(config.drive.lateral.max_velocity, 2);
  EXPECT_EQ(config.drive.lateral.min_velocity, -2);
  EXPECT_EQ(config.drive.linear.max_velocity, SpeedLimits::NONE);
  EXPECT_EQ(config.drive.source, DriveConfig::Odometry::WORLD);
  const auto told = [](const std::string& more) { return refusalOfList("{name: d, type: planar_drive, " + more + "}"); };
  EXPECT_TRUE(isOneLineWith(told("max_force: -1"), {"max_force", "at least 0"}));
  EXPECT_TRUE(isOneLineWith(told("left_wheel: a"), {"left_wheel", "unknown"}));
  EXPECT_TRUE(isOneLineWith(told("odometry_source: encoder"), {"odometry_source", "unknown"}));
}

TEST(ConfigControllers, RefusesFaultyDrivesThatSteer) {
  const auto told = [](const std::string& drive) { return refusalOfList("{name: d, type: steered_drive, " + drive + "}"); };
  EXPECT_TRUE(isOneLineWith(told("front_steer: s"), {"rear_wheel", "missing", "not steered"}));
  EXPECT_TRUE(isOneLineWith(told("rear_wheel: a"), {"front_steer", "missing", "steer"}));
  const std::string whole = "rear_wheel: a, front_steer: s";
  EXPECT_EQ(told(whole), "");
  EXPECT_TRUE(isOneLineWith(told(whole + ", wheel_separation_h: 0"), {"wheel_separation_h", "above 0"}));
  EXPECT_TRUE(isOneLineWith(told(whole + ", steering_speed: -1"), {"steering_speed", "at least 0"}));
  EXPECT_TRUE(isOneLineWith(told(whole + ", max_steering_angle: .nan"), {"max_steering_angle", "above 0"}));
  EXPECT_TRUE(isOneLineWith(told(whole + ", driven_wheel: []"), {"driven_wheel", "list"}));
  EXPECT_TRUE(isOneLineWith(told(whole + ", left_wheel: b"), {"left_wheel", "unknown"}));
}

TEST(ConfigControllers, KeysOfTheParameterServerGoOverThoseGiven) {
  ControllerConfig given;
  given.goal_time = 3;
  given.stopped_velocity_tolerance = 0.5;
  const ControllerConfig both = parseController(YAML::Load("{joints: [a], constraints: {goal_time: 1}}"), "/c", given);
  EXPECT_EQ(both.joints, std::vector<std::string>{"a"});
  EXPECT_EQ(both.goal_time, 1);
  EXPECT_EQ(both.stopped_velocity_tolerance, 0.5);
}

TEST(ConfigControllers, RefusesInOneLine) {
  EXPECT_TRUE(isOneLineWith(refusalOfList("{joints: [a]}"), {"controllers[0].name"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c}, {name: c}"), {"controllers[1].name", "'c'", "taken"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c, joints: a}"), {"controllers[0].joints", "list"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c, joints: [a, a]}"), {"'a'", "twice"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c, jonts: [a]}"), {"jonts", "'joints'"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c, constraints: {goal_time: -1}}"), {"goal_time", "at least 0"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c, constraints: {a: {gaol: 1}}}"), {"gaol", "'goal'"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c, state_publish_rate: .inf}"), {"state_publish_rate"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c, type: griper, joint: f}"), {"type", "gripper"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c, type: gripper}"), {"joint", "missing"}));
  EXPECT_TRUE(isOneLineWith(refusalOfList("{name: c, type: gripper, joint: f, joints: [f]}"), {"joints", "unknown"}));
}

}  // namespace
}  // namespace blem_sim::sim
