#include "robot_commands.h"

#include <ros/console.h>

#include <boost/function.hpp>
#include <iterator>

#include "blem_sim/geometry/input_error.h"
#include "messages/joint_messages.h"
#include "messages/ros_names.h"
#include "messages/trajectory_messages.h"

namespace blem_sim::node {

namespace {
constexpr int COMMAND_QUEUE = 100;
}

RobotCommands::RobotCommands(ros::NodeHandle node, sim::Simulator* simulator) : node_(node), simulator_(simulator) { modelsChanged(); }

void RobotCommands::modelsChanged() {
  for (auto robot = subscribers_.begin(); robot != subscribers_.end();)
    robot = simulator_->robotIndex(robot->first) < 0 ? subscribers_.erase(robot) : std::next(robot);
  for (const sim::RobotInfo& robot : simulator_->robots())
    if (subscribers_.count(robot.name) == 0 && takesItsOwn(robot)) subscribers_[robot.name] = subscribe(robot);
}

bool RobotCommands::takesItsOwn(const sim::RobotInfo& robot) const {
  for (const sim::RobotInfo& other : simulator_->robots()) {
    const std::string joint = subscribers_.count(other.name) > 0 ? sharedJoint(robot, other) : "";
    if (joint.empty()) continue;
    ROS_WARN("robots: %s: takes no commands: '%s' has a joint '%s' in its namespace too; set namespace", robot.name.c_str(),
             other.name.c_str(), joint.c_str());
    return false;
  }
  return true;
}

std::vector<ros::Subscriber> RobotCommands::subscribe(const sim::RobotInfo& info) {
  std::vector<ros::Subscriber> subscribers;
  ros::NodeHandle robot_node(node_, info.name_space);
  const std::string robot = info.name;
  const std::string trajectories = robot_node.resolveName("joint_trajectory"), commands = robot_node.resolveName("joint_command");
  const boost::function<void(const trajectory_msgs::JointTrajectoryConstPtr&)> on_trajectory =
      [this, robot, trajectories](const trajectory_msgs::JointTrajectoryConstPtr& message) { onTrajectory(robot, trajectories, *message); };
  const boost::function<void(const sensor_msgs::JointStateConstPtr&)> on_command =
      [this, robot, commands](const sensor_msgs::JointStateConstPtr& message) { onJointCommand(robot, commands, *message); };
  subscribers.push_back(robot_node.subscribe<trajectory_msgs::JointTrajectory>("joint_trajectory", COMMAND_QUEUE, on_trajectory));
  subscribers.push_back(robot_node.subscribe<sensor_msgs::JointState>("joint_command", COMMAND_QUEUE, on_command));
  return subscribers;
}

void RobotCommands::onTrajectory(const std::string& robot, const std::string& topic, const trajectory_msgs::JointTrajectory& message) {
  try {
    simulator_->commandTrajectory(simulator_->robotIndex(robot), fromMessage(message));
  } catch (const InputError& error) {
    ROS_ERROR("%s: trajectory refused: %s", topic.c_str(), error.what());
  }
}

void RobotCommands::onJointCommand(const std::string& robot, const std::string& topic, const sensor_msgs::JointState& message) {
  try {
    simulator_->commandJoints(simulator_->robotIndex(robot), commandOf(message));
  } catch (const InputError& error) {
    ROS_ERROR("%s: command refused: %s", topic.c_str(), error.what());
  }
}

}  // namespace blem_sim::node
