#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <vector>

#include "blem_sim/sim/simulator.h"

namespace blem_sim {

/**
 * Commands to a robot past its controllers, in its namespace: `joint_trajectory` (trajectory_msgs/JointTrajectory for some or all joints;
 * stamp 0 = now, no points = hold) and `joint_command` (sensor_msgs/JointState: targets by joint name). A faulty message changes nothing;
 * one error line names the fault.
 */
class RobotCommands {
 public:
  RobotCommands(ros::NodeHandle node, Simulator* simulator);

 private:
  void onTrajectory(int robot, const std::string& topic, const trajectory_msgs::JointTrajectory& message);
  void onJointCommand(int robot, const std::string& topic, const sensor_msgs::JointState& message);

  Simulator* simulator_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace blem_sim
