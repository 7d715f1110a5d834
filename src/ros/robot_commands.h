#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <map>
#include <string>
#include <vector>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::node {

/**
 * Commands to a robot past its controllers, in its namespace: `joint_trajectory` (trajectory_msgs/JointTrajectory for some or all joints;
 * stamp 0 = now, no points = hold) and `joint_command` (sensor_msgs/JointState: targets by joint name). A faulty message changes nothing;
 * one error line names the fault. Of robots of one namespace that have a joint of one name, the first alone takes commands; a line says so.
 */
class RobotCommands {
 public:
  RobotCommands(ros::NodeHandle node, sim::Simulator* simulator);
  /** Robots came or went. */
  void modelsChanged();

 private:
  /** False if commands of the robot are those of another one. */
  bool takesItsOwn(const sim::RobotInfo& robot) const;
  std::vector<ros::Subscriber> subscribe(const sim::RobotInfo& robot);
  void onTrajectory(const std::string& robot, const std::string& topic, const trajectory_msgs::JointTrajectory& message);
  void onJointCommand(const std::string& robot, const std::string& topic, const sensor_msgs::JointState& message);

  ros::NodeHandle node_;
  sim::Simulator* simulator_;
  std::map<std::string, std::vector<ros::Subscriber>> subscribers_;  // by name of the robot
};

}  // namespace blem_sim::node
