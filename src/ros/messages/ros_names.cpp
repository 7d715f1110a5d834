#include "messages/ros_names.h"

#include <ros/names.h>
#include <ros/node_handle.h>

#include <algorithm>

#include "messages/conversions.h"

namespace blem_sim::node {

std::string ownFrame(const sim::RobotInfo& robot, const std::string& name) {
  return robot.tf_prefix.empty() ? name : robot.tf_prefix + "/" + name;
}

std::string namedFrame(const sim::RobotInfo& robot, const std::string& name) {
  if (!name.empty() && name.front() == '/') return name.substr(1);
  return name == WORLD_FRAME || name == "map" ? name : ownFrame(robot, name);
}

std::string tfPrefixIn(const std::string& name_space) {
  const ros::NodeHandle node(name_space);
  std::string parameter, prefix;
  if (node.searchParam("tf_prefix", parameter)) node.getParam(parameter, prefix);
  return prefix;
}

bool isRosName(const std::string& name) {
  std::string error;
  return !name.empty() && name.front() != '~' && ros::names::validate(name, error);
}

bool hasJoint(const sim::RobotInfo& robot, const std::string& joint) {
  return std::find(robot.joint_names.begin(), robot.joint_names.end(), joint) != robot.joint_names.end();
}

bool shareNamespace(const sim::RobotInfo& a, const sim::RobotInfo& b) {
  return ros::names::clean("/" + a.name_space) == ros::names::clean("/" + b.name_space);
}

std::string sharedJoint(const sim::RobotInfo& a, const sim::RobotInfo& b) {
  if (!shareNamespace(a, b)) return "";
  const auto found = std::find_if(a.joint_names.begin(), a.joint_names.end(), [&](const std::string& joint) { return hasJoint(b, joint); });
  return found == a.joint_names.end() ? "" : *found;
}

}  // namespace blem_sim::node
