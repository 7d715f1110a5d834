#pragma once

#include <ros/node_handle.h>

#include <map>
#include <string>
#include <vector>

#include "loop/simulation_loop.h"

namespace blem_sim::node {

/**
 * Commands to a robot past its controllers, in its namespace: `joint_trajectory` (trajectory_msgs/JointTrajectory for some or all joints;
 * stamp 0 = now, no points = hold) and `joint_command` (sensor_msgs/JointState: targets by joint name). A faulty message changes nothing;
 * it is counted, and one error line names the fault. Of robots of one namespace that have a joint of one name, the first alone takes
 * commands; a line says so. A message whose joints are all another one's is that one's.
 */
class RobotCommands {
 public:
  RobotCommands(ros::NodeHandle node, SimulationLoop* loop);
  /** Robots came or went. */
  void modelsChanged();

 private:
  /** False if commands of the robot are those of another one. */
  bool takesItsOwn(const sim::RobotInfo& robot) const;
  /** Whether all joints are those of another robot in the namespace. */
  bool isForAnother(const sim::RobotInfo& robot, const std::vector<std::string>& joints) const;
  std::vector<ros::Subscriber> subscribe(const sim::RobotInfo& robot);

  ros::NodeHandle node_;
  sim::Simulator* simulator_;
  StampedCommands* stamped_;
  Refusals* refusals_;
  std::map<std::string, std::vector<ros::Subscriber>> subscribers_;  // by name of the robot
};

}  // namespace blem_sim::node
