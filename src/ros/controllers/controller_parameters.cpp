#include "controllers/controller_parameters.h"

#include <ros/console.h>
#include <ros/param.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <string>
#include <vector>

#include "messages/parameter_yaml.h"

namespace blem_sim::node {

namespace {
const char* const TYPE = "type";
}  // namespace

sim::ControllerConfig withParameters(const ros::NodeHandle& robot_node, const sim::ControllerConfig& settings) {
  const std::string place = robot_node.resolveName(settings.name);
  XmlRpc::XmlRpcValue given;
  if (!ros::param::get(place, given) || given.getType() != XmlRpc::XmlRpcValue::TypeStruct) return settings;
  YAML::Node node(YAML::NodeType::Map);
  const std::vector<std::string>& keys = sim::controllerKeys(settings.kind);
  std::string others;
  for (auto& [key, value] : given) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end())
      node[key] = toYaml(value);
    else if (key != TYPE)
      others += (others.empty() ? "" : ", ") + key;
  }
  if (!others.empty()) ROS_WARN("%s: not read: %s; docs/controllers.md has what is", place.c_str(), others.c_str());
  return sim::parseController(node, place, settings);
}

std::string controllerType(const ros::NodeHandle& robot_node, const std::string& name) {
  std::string type;
  ros::param::get(robot_node.resolveName(name) + "/" + TYPE, type);
  return type;
}

}  // namespace blem_sim::node
