#include "messages/ros_names.h"

#include <ros/names.h>
#include <ros/node_handle.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"
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

void checkNamespace(const sim::Simulator& simulator, const sim::RobotInfo& robot, const std::string& field) {
  const auto resolved = [](const std::string& name_space) { return ros::names::clean("/" + name_space); };
  for (const sim::RobotInfo& other : simulator.robots()) {
    if (other.name == robot.name || resolved(other.name_space) != resolved(robot.name_space)) continue;
    for (const std::string& joint : robot.joint_names)
      if (std::find(other.joint_names.begin(), other.joint_names.end(), joint) != other.joint_names.end())
        throw InputError(field + ": '" + other.name + "' has a joint '" + joint + "' in this namespace too; give '" + robot.name +
                         "' one of its own");
  }
}

}  // namespace blem_sim::node
