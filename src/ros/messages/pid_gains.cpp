#include "messages/pid_gains.h"

#include <ros/names.h>
#include <ros/param.h>
#include <yaml-cpp/yaml.h>

#include "messages/parameter_yaml.h"

namespace blem_sim::node {

std::map<std::string, sim::JointGains> pidGainsIn(const std::string& name_space) {
  const std::string parameter = ros::names::resolve(ros::names::append(name_space, "gazebo_ros_control/pid_gains"));
  XmlRpc::XmlRpcValue given;
  if (!ros::param::get(parameter, given)) return {};
  return sim::parsePidGains(toYaml(given), parameter);
}

}  // namespace blem_sim::node
