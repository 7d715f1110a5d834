// <gazebo> blocks of drives: what becomes of them, and what is told of the rest.
#include <gtest/gtest.h>

#include "blem_sim/sim/drive_controller.h"
#include "sim/controllers/rover.h"
#include "sim/controllers/steered_robots.h"
#include "sim/gazebo/described_robot.h"

namespace blem_sim::sim {
namespace {

std::string drivePlugin(const std::string& kind, const std::string& inside, const std::string& name = "wheels") {
  return "<gazebo><plugin name=\"" + name + "\" filename=\"libgazebo_ros_" + kind + ".so\">" + inside + "</plugin></gazebo>";
}

const char* const WHEELS =
    "<legacyMode>false</legacyMode><leftJoint>left_axle</leftJoint><rightJoint>right_axle</rightJoint>"
    "<wheelSeparation>0.4</wheelSeparation><wheelDiameter>0.2</wheelDiameter><robotBaseFrame>base_link</robotBaseFrame>";

GazeboRobot roverWith(const std::string& blocks, const RobotConfig& config = {}) {
  return withGazeboBlocks(config, model::loadUrdf(roverUrdf(blocks), "test.urdf", model::UriResolver()));
}

TEST(GazeboDrives, ADiffDriveIsRead) {
  const GazeboRobot robot = roverWith(drivePlugin(
      "diff_drive", WHEELS + std::string("<wheelAcceleration>1.5</wheelAcceleration><wheelTorque>7</wheelTorque><updateRate>20</updateRate>"
                                         "<commandTopic>cmd</commandTopic><odometryTopic>way</odometryTopic>"
                                         "<odometryFrame>/odom_combined</odometryFrame><odometrySource>encoder</odometrySource>"
                                         "<publishOdomTF>false</publishOdomTF><publishWheelTF>true</publishWheelTF>"
                                         "<publishWheelJointState>false</publishWheelJointState><rosDebugLevel>na</rosDebugLevel>"
                                         "<robotNamespace>/rover</robotNamespace><alwaysOn>true</alwaysOn><fudge>1</fudge>")));
  ASSERT_EQ(robot.config.drives.size(), 1u);
  const ControllerConfig& config = robot.config.drives.front();
  EXPECT_EQ(config.name, "wheels");
  EXPECT_EQ(config.kind, ControllerKind::DRIVE);
  EXPECT_EQ(config.joints, (std::vector<std::string>{"left_axle", "right_axle"}));
  EXPECT_EQ(config.drive.left, std::vector<std::string>{"left_axle"});
  EXPECT_EQ(config.drive.wheel_separation, 0.4);
  EXPECT_EQ(config.drive.wheel_radius, 0.1);
  EXPECT_EQ(config.drive.wheel_acceleration, 1.5);
  EXPECT_EQ(config.drive.wheel_torque, 7);
  EXPECT_EQ(config.drive.publish_rate, 20);
  EXPECT_EQ(config.drive.cmd_vel_timeout, 0);
  EXPECT_EQ(commandTopic(config), "/rover/cmd");
  EXPECT_EQ(odometryTopic(config), "/rover/way");
  EXPECT_EQ(config.drive.odom_frame, "odom_combined");
  EXPECT_EQ(config.drive.base_frame, "base_link");
  EXPECT_FALSE(config.drive.enable_odom_tf);
  EXPECT_EQ(config.drive.source, DriveConfig::Odometry::ENCODER);
  EXPECT_EQ(toldTimes(robot.notes, "drives of its <gazebo> blocks: wheels (on /rover/cmd)"), 1);
  EXPECT_EQ(toldTimes(robot.notes, "not read: plugin 'wheels' <fudge>"), 1);
  EXPECT_EQ(toldTimes(robot.notes, "without effect here: publishWheelTF, publishWheelJointState"), 1);
  EXPECT_EQ(robot.notes.size(), 3u);
}

TEST(GazeboDrives, APlanarMoveIsRead) {
  GazeboRobot robot =
      roverWith(drivePlugin("planar_move",
                            "<commandTopic>cmd</commandTopic><odometryTopic>way</odometryTopic><odometryFrame>map</odometryFrame>"
                            "<odometryRate>30</odometryRate><robotBaseFrame>base_link</robotBaseFrame>"
                            "<cmdTimeout>0.4</cmdTimeout>"));
  ASSERT_EQ(robot.config.drives.size(), 1u);
  const ControllerConfig& config = robot.config.drives.front();
  EXPECT_EQ(config.kind, ControllerKind::PLANAR_DRIVE);
  EXPECT_TRUE(config.joints.empty());
  EXPECT_EQ(config.drive.command_topic, "cmd");
  EXPECT_EQ(config.drive.odom_topic, "way");
  EXPECT_EQ(config.drive.odom_frame, "map");
  EXPECT_EQ(config.drive.publish_rate, 30);
  EXPECT_EQ(config.drive.base_frame, "base_link");
  EXPECT_EQ(config.drive.cmd_vel_timeout, 0.4);
  EXPECT_EQ(config.drive.max_force, 0);
  EXPECT_TRUE(config.drive.enable_odom_tf);
  EXPECT_EQ(config.drive.source, DriveConfig::Odometry::WORLD);
  EXPECT_EQ(robot.notes.size(), 1u);
  robot = roverWith(drivePlugin("planar_move", ""));
  ASSERT_EQ(robot.config.drives.size(), 1u);
  const DriveConfig& drive = robot.config.drives.front().drive;
  EXPECT_EQ(drive.command_topic, "cmd_vel");
  EXPECT_EQ(drive.odom_topic, "odom");
  EXPECT_EQ(drive.odom_frame, "odom");
  EXPECT_EQ(drive.publish_rate, 20);
  EXPECT_EQ(drive.cmd_vel_timeout, 0) << "never";
  EXPECT_EQ(toldTimes(robot.notes, "'base_footprint'"), 1) << "the root link is taken";
  RobotConfig held;
  held.fixed_base = true;
  robot = roverWith(drivePlugin("planar_move", ""), held);
  EXPECT_TRUE(robot.config.drives.empty());
  EXPECT_EQ(toldTimes(robot.notes, "base is fixed"), 1);
}

TEST(GazeboDrives, WithoutLegacyModeLeftIsRightAsInGazebo) {
  const GazeboRobot robot = roverWith(drivePlugin("diff_drive", "<leftJoint>left_axle</leftJoint><rightJoint>right_axle</rightJoint>"));
  ASSERT_EQ(robot.config.drives.size(), 1u);
  const DriveConfig& drive = robot.config.drives.front().drive;
  EXPECT_EQ(drive.left, std::vector<std::string>{"right_axle"});
  EXPECT_EQ(drive.wheel_separation, 0.34);
  EXPECT_EQ(drive.wheel_radius, 0.075);
  EXPECT_EQ(drive.wheel_torque, 5);
  EXPECT_EQ(drive.publish_rate, 100);
  EXPECT_EQ(drive.source, DriveConfig::Odometry::WORLD);
  EXPECT_TRUE(drive.enable_odom_tf);
  EXPECT_EQ(toldTimes(robot.notes, "<legacyMode>"), 1);
  EXPECT_EQ(toldTimes(robot.notes, "<robotBaseFrame>: there is no link 'base_footprint'"), 1);
}

TEST(GazeboDrives, ASkidSteerDriveIsRead) {
  const std::string wheels =
      "<leftFrontJoint>left_axle</leftFrontJoint><rightFrontJoint>right_axle</rightFrontJoint>"
      "<leftRearJoint>left_rear</leftRearJoint><rightRearJoint>right_rear</rightRearJoint><torque>9</torque>"
      "<broadcastTF>true</broadcastTF><covariance_x>0.5</covariance_x><robotBaseFrame>base_link</robotBaseFrame>";
  std::string rear;
  for (const std::string side : {"left", "right"})
    rear += "<link name=\"" + side + "_rear_wheel\"/><joint name=\"" + side +
            "_rear\" type=\"continuous\"><parent link=\"base_link\"/><child link=\"" + side + "_rear_wheel\"/></joint>";
  const GazeboRobot robot = roverWith(rear + drivePlugin("skid_steer_drive", wheels));
  ASSERT_EQ(robot.config.drives.size(), 1u);
  const ControllerConfig& config = robot.config.drives.front();
  EXPECT_EQ(config.drive.left, (std::vector<std::string>{"left_axle", "left_rear"}));
  EXPECT_EQ(config.drive.right, (std::vector<std::string>{"right_axle", "right_rear"}));
  EXPECT_EQ(config.joints.size(), 4u);
  EXPECT_EQ(config.drive.wheel_separation, 0.4);
  EXPECT_EQ(config.drive.wheel_torque, 9);
  EXPECT_EQ(config.drive.pose_covariance[0], 0.5);
  EXPECT_TRUE(config.drive.enable_odom_tf);
  EXPECT_EQ(robot.notes.size(), 1u);
}

TEST(GazeboDrives, WhatCannotBeDrivenIsToldAndLeftOut) {
  const auto note = [](const std::string& left, const std::string& right, const std::string& more = "") {
    const GazeboRobot robot =
        roverWith(drivePlugin("diff_drive", "<legacyMode>false</legacyMode><robotBaseFrame>base_link</robotBaseFrame><leftJoint>" + left +
                                                "</leftJoint><rightJoint>" + right + "</rightJoint>" + more));
    EXPECT_TRUE(robot.config.drives.empty());
    EXPECT_EQ(robot.notes.size(), 1u);
    return robot.notes;
  };
  EXPECT_EQ(
      toldTimes(note("left_axel", "right_axle"), "test.urdf: plugin 'wheels': there is no joint 'left_axel' (the nearest is 'left_axle')"),
      1);
  EXPECT_EQ(toldTimes(note("mount", "right_axle"), "joint 'mount' is none that turns"), 1);
  EXPECT_EQ(toldTimes(note("left_axle", "left_axle"), "joint 'left_axle' is there twice"), 1);
  EXPECT_EQ(toldTimes(note("left_axle", "right_axle", "<commandTopic>cmd vel</commandTopic>"), "'cmd vel' is no ROS topic"), 1);
  const GazeboRobot zero = roverWith(drivePlugin("diff_drive", WHEELS + std::string("<odometrySource>stars</odometrySource>")) +
                                     drivePlugin("diff_drive",
                                                 "<legacyMode>false</legacyMode><leftJoint>left_axle</leftJoint>"
                                                 "<rightJoint>right_axle</rightJoint><wheelSeparation>0</wheelSeparation>"
                                                 "<robotBaseFrame>base_link</robotBaseFrame>",
                                                 "second"));
  EXPECT_EQ(zero.config.drives.size(), 2u);
  EXPECT_EQ(zero.config.drives.back().drive.wheel_separation, 0.34);
  EXPECT_EQ(toldTimes(zero.notes, "<wheelSeparation>: is 0; it is left out"), 1);
  EXPECT_EQ(toldTimes(zero.notes, "<odometrySource>: 'stars'"), 1);
}

const char* const TRICYCLE =
    "<steeringJoint>front_steer</steeringJoint><actuatedWheelJoint>front_axle</actuatedWheelJoint><encoderWheelLeftJoint>left_axle"
    "</encoderWheelLeftJoint><encoderWheelRightJoint>right_axle</encoderWheelRightJoint>";

GazeboRobot tricycleWith(const std::string& blocks) {
  return withGazeboBlocks({}, model::loadUrdf(tricycleUrdf(blocks), "test.urdf", model::UriResolver()));
}

TEST(GazeboDrives, ATricycleDriveIsRead) {
  const GazeboRobot robot = tricycleWith(drivePlugin(
      "tricycle_drive", TRICYCLE + std::string("<actuatedWheelDiameter>0.2</actuatedWheelDiameter><encoderWheelDiameter>0.3"
                                               "</encoderWheelDiameter><wheelAcceleration>4</wheelAcceleration><wheelDeceleration>4"
                                               "</wheelDeceleration><wheelTorque>7</wheelTorque><steeringSpeed>0.4</steeringSpeed>"
                                               "<odometrySource>encoder</odometrySource><updateRate>20</updateRate>"
                                               "<commandTopic>cmd</commandTopic><steeringAngleTolerance>0.02</steeringAngleTolerance>"
                                               "<encoderWheelSeparation>0.4</encoderWheelSeparation>")));
  ASSERT_EQ(robot.config.drives.size(), 1u);
  const ControllerConfig& config = robot.config.drives.front();
  EXPECT_EQ(config.kind, ControllerKind::STEERED_DRIVE);
  EXPECT_EQ(config.joints, (std::vector<std::string>{"left_axle", "right_axle", "front_steer", "front_axle"}));
  EXPECT_EQ(config.drive.steering.steered_radius, 0.1);
  EXPECT_EQ(config.drive.wheel_radius, 0.15);
  EXPECT_EQ(config.drive.wheel_acceleration, 0.4) << "4 rad/s^2";
  EXPECT_EQ(config.drive.wheel_torque, 7);
  EXPECT_EQ(config.drive.steering.speed, 0.4);
  EXPECT_TRUE(config.drive.steering.takes_angles);
  EXPECT_EQ(config.drive.source, DriveConfig::Odometry::ENCODER);
  EXPECT_EQ(config.drive.base_frame, "base_link");
  EXPECT_EQ(commandTopic(config), "cmd");
  EXPECT_EQ(toldTimes(robot.notes, "without effect here: encoderWheelSeparation, steeringAngleTolerance"), 1);
  EXPECT_EQ(robot.notes.size(), 2u);
}

TEST(GazeboDrives, ATricycleThatCannotSteerIsToldAndLeftOut) {
  const GazeboRobot robot =
      tricycleWith(drivePlugin("tricycle_drive",
                               "<steeringJoint>front_steer</steeringJoint><actuatedWheelJoint>right_axle</actuatedWheelJoint>"
                               "<encoderWheelLeftJoint>left_axle</encoderWheelLeftJoint><encoderWheelRightJoint>front_axle"
                               "</encoderWheelRightJoint><wheelDeceleration>2</wheelDeceleration>"));
  EXPECT_TRUE(robot.config.drives.empty());
  EXPECT_EQ(toldTimes(robot.notes, "rear_wheel: 'front_axle' hangs on a joint of front_steer"), 1);
  EXPECT_EQ(toldTimes(robot.notes, "the drive is left out"), 1);
  EXPECT_EQ(toldTimes(robot.notes, "<wheelDeceleration>"), 1);
}

TEST(GazeboDrives, AControllerOfItsNameBeatsIt) {
  RobotConfig config;
  config.controllers = {ControllerConfig()};
  config.controllers->front().name = "wheels";
  EXPECT_TRUE(roverWith(drivePlugin("diff_drive", WHEELS), config).config.drives.empty());
}

TEST(GazeboDrives, ARobotLeavesTopicAndFrameToItsDrive) {
  Simulator simulator(roverScene(drivePlugin("diff_drive", WHEELS)), model::UriResolver());
  const RobotInfo& info = simulator.robots()[0];
  ASSERT_EQ(info.drives.size(), 1u);
  EXPECT_EQ(info.odom.topic, "ground_truth/odom");
  EXPECT_EQ(toldTimes(simulator.notes(), "/odom has the odometry of 'wheels'; the truth is on ground_truth/odom"), 1);
  EXPECT_EQ(toldTimes(simulator.notes(), "joints without gains"), 0) << "a wheel needs none";
  DriveController drive(&simulator, 0, info.drives.front());
  drive.start();
  drive.command({0.3, 0});
  stepFor(&simulator, 1);
  EXPECT_NEAR(drive.odometry().X_OB.translation().x(), 0.3, 0.01);
}

}  // namespace
}  // namespace blem_sim::sim
