#include "parameters.h"

#include <ros/console.h>
#include <ros/names.h>
#include <ros/param.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "blem_sim/geometry/input_error.h"
#include "messages/parameter_yaml.h"
#include "messages/pid_gains.h"
#include "messages/ros_names.h"

namespace blem_sim::node {

namespace {

const char* const DEFAULT_DESCRIPTION = "robot_description";

/** Takes a text out of the parameters, for keys that parseConfig does not know. */
std::string takeText(YAML::Node* parameters, const std::string& key, const std::string& source) {
  const YAML::Node value = (*parameters)[key];
  if (!value) return "";
  if (!value.IsScalar()) throw InputError(source + ": " + key + ": must be a string");
  const auto text = value.as<std::string>();
  parameters->remove(key);
  return text;
}

/** Takes keys out of the parameters that launch files for Gazebo set, with a note where they mean something there. */
void takeGazeboKeys(YAML::Node* parameters) {
  parameters->remove("enable_ros_network");
  if (!(*parameters)["world_name"].IsDefined()) return;
  ROS_WARN("world_name: world files are SDF, which is not read; make a YAML of it by rosrun blem_sim world_from_sdf, a plane stands in");
  parameters->remove("world_name");
}

std::string directoryOf(const std::string& file) {
  const auto slash = file.rfind('/');
  return slash == std::string::npos ? "" : file.substr(0, slash);
}

/** The name attribute of <robot>; a description without one is refused later, by the URDF loader, with its own words. */
std::string robotName(const std::string& xml) {
  const auto tag = xml.find("<robot");
  const auto end = xml.find('>', tag == std::string::npos ? xml.size() : tag);
  if (end == std::string::npos) return "robot";
  const std::string attributes = xml.substr(tag, end - tag);
  auto begin = attributes.find("name=");
  if (begin == std::string::npos || begin + 6 >= attributes.size()) return "robot";
  begin += 5;
  const auto close = attributes.find(attributes[begin], begin + 1);
  return close == std::string::npos ? "robot" : attributes.substr(begin + 1, close - begin - 1);
}

std::string readFile(const std::string& file, const std::string& source) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  if (!stream || text.str().empty()) throw InputError(source + ": robot_description_file: cannot read '" + file + "'");
  return text.str();
}

/** Takes the settings of a robot that is made without a list of robots: its row, without its URDF. */
YAML::Node takeRobotRow(YAML::Node* parameters) {
  YAML::Node row(YAML::NodeType::Map);
  for (const auto& [key, row_key] : {std::make_pair("robot_pose", "pose"), std::make_pair("robot_fixed_base", "fixed_base")}) {
    if ((*parameters)[key].IsDefined()) row[row_key] = YAML::Clone((*parameters)[key]);
    parameters->remove(key);
  }
  return row;
}

/** List of the one robot of a URDF that is given without a list of robots; empty if there is no URDF either. */
YAML::Node describedRobots(YAML::Node row, const std::string& file, const std::string& base_directory, const std::string& source) {
  YAML::Node robots(YAML::NodeType::Sequence);
  std::string xml;
  if (!file.empty()) {
    const std::string path = model::UriResolver().resolve(file, base_directory);
    xml = readFile(path, source);
    row["urdf"] = path;
  } else if (ros::param::has(DEFAULT_DESCRIPTION)) {
    ros::param::get(DEFAULT_DESCRIPTION, xml);
    row["description_param"] = DEFAULT_DESCRIPTION;  // what is no text is refused where all descriptions are fetched
  } else {
    return robots;
  }
  row["name"] = robotName(xml);
  robots.push_back(row);
  return robots;
}

/** Adds one more environment; what is no list is left to parseConfig to refuse. */
void addEnvironment(const std::string& uri, YAML::Node* parameters) {
  YAML::Node row(YAML::NodeType::Map);
  row["name"] = "environment";
  row["uri"] = uri;
  YAML::Node environments = (*parameters)["environments"];
  if (!environments.IsDefined() || environments.IsNull() || environments.IsSequence()) environments.push_back(row);
}

void fetchDescriptions(const std::string& source, sim::SimulationConfig* config) {
  for (sim::RobotConfig& robot : config->robots) {
    if (robot.description_param.empty()) continue;
    const std::string parameter = ros::names::resolve(robot.description_param);
    if (!ros::param::get(parameter, robot.urdf_xml) || robot.urdf_xml.empty()) {
      throw InputError(source + ": robots: " + robot.name + ": description_param: there is no string parameter " + parameter +
                       ", or it is empty; set it before the node starts, or give urdf: FILE");
    }
  }
}

/** Names that only ROS can refuse. @throws InputError */
void checkNames(const std::string& source, const sim::SimulationConfig& config) {
  const std::string cure = "' is no ROS name; use letters, digits, _ and /, a letter or / first";
  for (std::size_t i = 0; i < config.robots.size(); ++i) {
    const std::string& name_space = config.robots[i].name_space;
    if (!name_space.empty() && !isRosName(name_space))
      throw InputError(source + ": robots[" + std::to_string(i) + "].namespace: '" + name_space + cure);
  }
  for (std::size_t i = 0; i < config.environments.size(); ++i) {
    const std::string& topic = config.environments[i].live.topic;
    if (!topic.empty() && !isRosName(topic)) throw InputError(source + ": environments[" + std::to_string(i) + "].topic: '" + topic + cure);
  }
}

}  // namespace

std::vector<std::string> serviceFolders(const sim::SimulationConfig& config) {
  if (!config.allow_file_services) return {};
  std::vector<std::string> folders = config.file_roots;
  if (!config.base_directory.empty()) folders.push_back(config.base_directory);
  const char* packages = std::getenv("ROS_PACKAGE_PATH");
  std::istringstream stream(packages ? packages : "");
  for (std::string folder; std::getline(stream, folder, ':');)
    if (!folder.empty()) folders.push_back(folder);
  return folders;
}

std::string checkpointFile(const sim::SimulationConfig& config, const ros::NodeHandle& private_node) {
  namespace fs = std::filesystem;
  if (!config.checkpoint_file.empty()) return fs::absolute(fs::path(config.base_directory) / config.checkpoint_file).string();
  std::string name = private_node.getNamespace().substr(1);
  std::replace(name.begin(), name.end(), '/', '_');
  const char *ros_home = std::getenv("ROS_HOME"), *home = std::getenv("HOME");
  const fs::path folder = ros_home ? fs::path(ros_home) : fs::path(home ? home : ".") / ".ros";
  std::error_code error;
  fs::create_directories(folder, error);  // what cannot be written is told at the first checkpoint
  return fs::absolute(folder / (name + ".checkpoint")).string();
}

NodeParameters readParameters(const ros::NodeHandle& private_node) {
  const std::string source = private_node.getNamespace();
  XmlRpc::XmlRpcValue given;
  YAML::Node parameters(YAML::NodeType::Map);
  if (ros::param::get(source, given)) parameters = toYaml(given);
  if (!parameters.IsMap()) throw InputError(source + ": the node's parameters must be a map of keys, as config/default.yaml has them");

  takeGazeboKeys(&parameters);
  const std::string config_file = takeText(&parameters, "config_file", source);
  const std::string environment = takeText(&parameters, "environment", source);
  const std::string description_file = takeText(&parameters, "robot_description_file", source);
  takeText(&parameters, DEFAULT_DESCRIPTION, source);  // may be kept here, for robots: {description_param: ~robot_description}
  const YAML::Node robot_row = takeRobotRow(&parameters);
  if (!parameters["robots"].IsDefined()) {
    parameters["robots"] = describedRobots(robot_row, description_file, directoryOf(config_file), source);
  }
  if (!environment.empty()) addEnvironment(environment, &parameters);
  sim::SimulationConfig config = sim::parseConfig(parameters, source, directoryOf(config_file));
  fetchDescriptions(source, &config);
  checkNames(source, config);
  for (sim::RobotConfig& robot : config.robots) {
    robot.pid_gains = pidGainsIn(robot.name_space);
    if (robot.tf_prefix.empty()) robot.tf_prefix = tfPrefixIn(robot.name_space);
  }
  return {config, YAML::Dump(parameters)};
}

}  // namespace blem_sim::node
