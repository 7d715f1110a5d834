#include "robot_commands.h"

#include <ros/console.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <algorithm>
#include <iterator>

#include "messages/joint_messages.h"
#include "messages/ros_names.h"
#include "messages/trajectory_messages.h"

namespace blem_sim::node {

RobotCommands::RobotCommands(ros::NodeHandle node, SimulationLoop* loop)
    : node_(node), simulator_(&loop->simulator()), stamped_(loop->stampedCommands()), refusals_(loop->refusals()) {
  modelsChanged();
}

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

bool RobotCommands::isForAnother(const sim::RobotInfo& robot, const std::vector<std::string>& joints) const {
  const auto has_all = [&](const sim::RobotInfo& other) {
    return std::all_of(joints.begin(), joints.end(), [&](const std::string& joint) { return hasJoint(other, joint); });
  };
  const std::vector<sim::RobotInfo>& robots = simulator_->robots();
  return !joints.empty() && std::any_of(robots.begin(), robots.end(), [&](const sim::RobotInfo& other) {
    return other.name != robot.name && subscribers_.count(other.name) > 0 && shareNamespace(other, robot) && has_all(other);
  });
}

std::vector<ros::Subscriber> RobotCommands::subscribe(const sim::RobotInfo& info) {
  const ros::NodeHandle robot_node(node_, info.name_space);
  const auto robot = [simulator = simulator_, name = info.name] { return simulator->robotIndex(name); };
  const auto is_mine = [this, robot](const std::vector<std::string>& joints) {
    return !isForAnother(simulator_->robots()[robot()], joints);
  };
  std::vector<ros::Subscriber> subscribers;
  subscribers.push_back(subscribeCounted<trajectory_msgs::JointTrajectory>(robot_node, "joint_trajectory", "trajectory refused", refusals_,
                                                                           [this, robot, is_mine](const auto& message) {
                                                                             if (is_mine(message.joint_names))
                                                                               simulator_->commandTrajectory(robot(), fromMessage(message));
                                                                           }));
  subscribers.push_back(subscribeCounted<sensor_msgs::JointState>(
      robot_node, "joint_command", "command refused", refusals_, [this, robot, is_mine](const auto& message) {
        if (is_mine(message.name)) stamped_->give(robot(), commandOf(message), message.header.stamp.toSec());
      }));
  return subscribers;
}

}  // namespace blem_sim::node
