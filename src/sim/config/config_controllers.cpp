#include <algorithm>

#include "config/config_sections.h"

namespace blem_sim::sim {

namespace {

const std::vector<std::string> TRAJECTORY_KEYS = {
    "joints", "state_publish_rate", "action_monitor_rate", "stop_trajectory_duration", "allow_partial_joints_goal", "constraints"};
const std::vector<std::string> GRIPPER_KEYS = {"joint", "action_monitor_rate", "goal_tolerance", "stall_velocity_threshold",
                                               "stall_timeout"};

void readJoints(YamlReader& reader, std::vector<std::string>* joints) {
  const YAML::Node list = reader.node("joints");
  if (!list.IsDefined()) return;
  const std::string wanted = "must be a list of names of joints: [JointA, JointB]; an empty one means all";
  if (!list.IsSequence()) reader.refuse("joints", wanted);
  joints->clear();
  for (const auto& joint : list) {
    if (!joint.IsScalar()) reader.refuse("joints", wanted);
    if (std::find(joints->begin(), joints->end(), joint.Scalar()) != joints->end())
      reader.refuse("joints", "'" + joint.Scalar() + "' is there twice; name it once");
    joints->push_back(joint.Scalar());
  }
}

void readJointConstraint(const std::string& joint, YamlReader& map, JointConstraint* constraint) {
  YamlReader reader = map.section(joint);
  reader.read("trajectory", &constraint->trajectory, NumberRange::notNegative());
  reader.read("goal", &constraint->goal, NumberRange::notNegative());
  reader.finish();
}

/** Two keys of all joints stand beside the names of joints. */
void readConstraints(YamlReader& controller, ControllerConfig* config) {
  controller.forEachName("constraints", [&](const std::string& name, YamlReader& map) {
    if (name == "goal_time")
      map.read(name, &config->goal_time, NumberRange::notNegative());
    else if (name == "stopped_velocity_tolerance")
      map.read(name, &config->stopped_velocity_tolerance, NumberRange::notNegative());
    else
      readJointConstraint(name, map, &config->joint_constraints[name]);
  });
}

void readTrajectorySettings(YamlReader& reader, ControllerConfig* config) {
  readJoints(reader, &config->joints);
  reader.readRate("state_publish_rate", &config->state_publish_rate);
  reader.read("stop_trajectory_duration", &config->stop_trajectory_duration, NumberRange::notNegative());
  reader.read("allow_partial_joints_goal", &config->allow_partial_joints_goal);
  readConstraints(reader, config);
}

void readGripperSettings(YamlReader& reader, ControllerConfig* config) {
  std::string joint = config->joints.empty() ? "" : config->joints.front();
  reader.read("joint", &joint);
  if (joint.empty()) reader.refuse("joint", "is missing; name the joint that the gripper's motor moves");
  config->joints = {joint};
  reader.read("goal_tolerance", &config->goal_tolerance, NumberRange::positive());
  reader.read("stall_velocity_threshold", &config->stall_velocity_threshold, NumberRange::notNegative());
  reader.read("stall_timeout", &config->stall_timeout, NumberRange::notNegative());
}

void readSettings(YamlReader& reader, ControllerConfig* config) {
  if (isDrive(config->kind)) return readDrive(reader, config);
  reader.readRate("action_monitor_rate", &config->action_monitor_rate);
  if (config->kind == ControllerKind::GRIPPER)
    readGripperSettings(reader, config);
  else
    readTrajectorySettings(reader, config);
}

}  // namespace

const std::vector<std::string>& controllerKeys(ControllerKind kind) {
  if (isDrive(kind)) return driveKeys(kind);
  return kind == ControllerKind::GRIPPER ? GRIPPER_KEYS : TRAJECTORY_KEYS;
}

ControllerConfig parseController(const YAML::Node& node, const std::string& source, ControllerConfig settings) {
  YamlReader reader(node, source);
  readSettings(reader, &settings);
  reader.finish();
  return settings;
}

std::optional<std::vector<ControllerConfig>> readControllers(YamlReader& robot) {
  if (!robot.has("controllers")) return {};
  std::vector<ControllerConfig> controllers;
  robot.forEachItem("controllers", [&](YamlReader& reader) {
    ControllerConfig config;
    config.name = readName(reader);
    config.kind = static_cast<ControllerKind>(
        reader.choice("type", {"joint_trajectory", "gripper", "diff_drive", "steered_drive", "planar_drive"}).value_or(0));
    readSettings(reader, &config);
    const auto same = [&](const ControllerConfig& other) { return other.name == config.name; };
    if (std::any_of(controllers.begin(), controllers.end(), same))
      reader.refuse("name", "'" + config.name + "' is taken by another controller");
    controllers.push_back(std::move(config));
  });
  return controllers;
}

}  // namespace blem_sim::sim
