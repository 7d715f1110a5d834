#include "messages/robot_frames.h"

#include <ros/node_handle.h>

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

}  // namespace blem_sim::node
