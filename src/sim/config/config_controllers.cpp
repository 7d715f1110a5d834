#include <algorithm>
#include <array>

#include "config/config_sections.h"

namespace blem_sim::sim {

namespace {

const std::vector<std::string> TRAJECTORY_KEYS = {
    "joints", "state_publish_rate", "action_monitor_rate", "stop_trajectory_duration", "allow_partial_joints_goal", "constraints"};
const std::vector<std::string> GRIPPER_KEYS = {"joint", "action_monitor_rate", "goal_tolerance", "stall_velocity_threshold",
                                               "stall_timeout"};
const std::vector<std::string> DRIVE_KEYS = {"left_wheel",
                                             "right_wheel",
                                             "wheel_separation",
                                             "wheel_radius",
                                             "wheel_separation_multiplier",
                                             "wheel_radius_multiplier",
                                             "wheel_acceleration",
                                             "wheel_torque",
                                             "cmd_vel_timeout",
                                             "cmd_vel_topic",
                                             "odom_topic",
                                             "odom_frame_id",
                                             "base_frame_id",
                                             "publish_rate",
                                             "enable_odom_tf",
                                             "odometry_source",
                                             "pose_covariance_diagonal",
                                             "twist_covariance_diagonal"};

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

/** One name or a list of them. */
void readWheels(YamlReader& reader, const std::string& key, std::vector<std::string>* wheels) {
  const YAML::Node given = reader.node(key);
  const std::string wanted = "must be a wheel's joint, or a list of them: [front, rear]";
  if (!given.IsDefined() && !wheels->empty()) return;
  if (!given.IsDefined()) reader.refuse(key, "is missing; name the joints of the wheels on that side");
  wheels->clear();
  if (given.IsScalar()) return wheels->push_back(given.Scalar());
  if (!given.IsSequence() || given.size() == 0) reader.refuse(key, wanted);
  for (const auto& wheel : given) {
    if (!wheel.IsScalar()) reader.refuse(key, wanted);
    wheels->push_back(wheel.Scalar());
  }
}

void readCovariance(YamlReader& reader, const std::string& key, std::array<double, 6>* diagonal) {
  const auto numbers = reader.numbers(key, diagonal->size());
  if (!numbers) return;
  if (*std::min_element(numbers->begin(), numbers->end()) < 0) reader.refuse(key, "has a number below 0; variances are 0 at least");
  std::copy(numbers->begin(), numbers->end(), diagonal->begin());
}

void readDriveOdometry(YamlReader& reader, DriveConfig* drive) {
  reader.read("odom_topic", &drive->odom_topic);
  reader.read("odom_frame_id", &drive->odom_frame);
  reader.read("base_frame_id", &drive->base_frame);
  if (drive->odom_frame.empty()) reader.refuse("odom_frame_id", "is empty; leave it out, or give it a name");
  reader.readRate("publish_rate", &drive->publish_rate);
  reader.read("enable_odom_tf", &drive->enable_odom_tf);
  if (const auto source = reader.choice("odometry_source", {"encoder", "world"}))
    drive->source = static_cast<DriveConfig::Odometry>(*source);
  readCovariance(reader, "pose_covariance_diagonal", &drive->pose_covariance);
  readCovariance(reader, "twist_covariance_diagonal", &drive->twist_covariance);
}

void readDriveSettings(YamlReader& reader, ControllerConfig* config) {
  DriveConfig& drive = config->drive;
  readWheels(reader, "left_wheel", &drive.left);
  readWheels(reader, "right_wheel", &drive.right);
  config->joints = drive.left;
  config->joints.insert(config->joints.end(), drive.right.begin(), drive.right.end());
  reader.read("wheel_separation", &drive.wheel_separation, NumberRange::positive());
  reader.read("wheel_radius", &drive.wheel_radius, NumberRange::positive());
  reader.read("wheel_separation_multiplier", &drive.separation_multiplier, NumberRange::positive());
  reader.read("wheel_radius_multiplier", &drive.radius_multiplier, NumberRange::positive());
  reader.read("wheel_acceleration", &drive.wheel_acceleration, NumberRange::notNegative());
  reader.read("wheel_torque", &drive.wheel_torque, NumberRange::notNegative());
  reader.read("cmd_vel_timeout", &drive.cmd_vel_timeout, NumberRange::notNegative());
  reader.read("cmd_vel_topic", &drive.command_topic);
  readDriveOdometry(reader, &drive);
}

void readSettings(YamlReader& reader, ControllerConfig* config) {
  if (config->kind == ControllerKind::DRIVE) return readDriveSettings(reader, config);
  reader.readRate("action_monitor_rate", &config->action_monitor_rate);
  if (config->kind == ControllerKind::GRIPPER)
    readGripperSettings(reader, config);
  else
    readTrajectorySettings(reader, config);
}

}  // namespace

const std::vector<std::string>& controllerKeys(ControllerKind kind) {
  if (kind == ControllerKind::DRIVE) return DRIVE_KEYS;
  return kind == ControllerKind::GRIPPER ? GRIPPER_KEYS : TRAJECTORY_KEYS;
}

std::string commandTopic(const ControllerConfig& drive) {
  return drive.drive.command_topic.empty() ? drive.name + "/cmd_vel" : drive.drive.command_topic;
}

std::string odometryTopic(const ControllerConfig& drive) {
  return drive.drive.odom_topic.empty() ? drive.name + "/odom" : drive.drive.odom_topic;
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
    config.kind = static_cast<ControllerKind>(reader.choice("type", {"joint_trajectory", "gripper", "diff_drive"}).value_or(0));
    readSettings(reader, &config);
    const auto same = [&](const ControllerConfig& other) { return other.name == config.name; };
    if (std::any_of(controllers.begin(), controllers.end(), same))
      reader.refuse("name", "'" + config.name + "' is taken by another controller");
    controllers.push_back(std::move(config));
  });
  return controllers;
}

}  // namespace blem_sim::sim
