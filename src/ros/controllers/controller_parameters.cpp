#include "controllers/controller_parameters.h"

#include <ros/param.h>
#include <yaml-cpp/yaml.h>

#include "messages/parameter_yaml.h"

namespace blem_sim::node {

sim::ControllerConfig withParameters(const ros::NodeHandle& robot_node, const sim::ControllerConfig& settings) {
  const std::string place = robot_node.resolveName(settings.name);
  XmlRpc::XmlRpcValue given;
  if (!ros::param::get(place, given) || given.getType() != XmlRpc::XmlRpcValue::TypeStruct) return settings;
  YAML::Node node(YAML::NodeType::Map);
  for (const std::string& key : sim::controllerKeys(settings.kind))
    if (given.hasMember(key)) node[key] = toYaml(given[key]);
  return sim::parseController(node, place, settings);
}

std::string controllerType(const ros::NodeHandle& robot_node, const std::string& name) {
  std::string type;
  ros::param::get(robot_node.resolveName(name) + "/type", type);
  return type;
}

}  // namespace blem_sim::node
