#include "gazebo/gazebo_drives.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "gazebo/gazebo_names.h"
#include "gazebo/gazebo_plugin_types.h"
#include "gazebo/gazebo_reader.h"
#include "wheels/undercarriage.h"
#include "wheels/wheel_measures.h"

namespace blem_sim::sim {
namespace {

constexpr std::size_t MOST_DRIVES = 100;   // of a robot
constexpr double SHORTEST_TIMEOUT = 1e-6;  // [s] in the place of 0, after which a command ends with its step

/** A drive as all plugins for them take it for granted. */
ControllerConfig gazebosDefaults(const std::string& name) {
  ControllerConfig config;
  config.name = name;
  config.kind = ControllerKind::DRIVE;
  DriveConfig& drive = config.drive;
  drive.wheel_radius = 0.075;
  drive.wheel_torque = 5;
  drive.cmd_vel_timeout = 0;
  drive.command_topic = "cmd_vel";
  drive.odom_topic = "odom";
  drive.base_frame = "base_footprint";
  drive.publish_rate = 100;
  drive.source = DriveConfig::Odometry::WORLD;
  return config;
}

std::string wheel(GazeboReader* reader, const char* path, const char* by_default) { return reader->text(path).value_or(by_default); }

void readFlag(GazeboReader* reader, const char* path, bool* value) {
  std::optional<bool> given;
  reader->read(path, &given);
  *value = given.value_or(*value);
}

/** A frame that must not begin with a slash, as tf2 has it. */
void readFrame(GazeboReader* reader, const char* path, std::string* frame) {
  reader->read(path, frame);
  frame->erase(0, std::min(frame->find_first_not_of('/'), frame->size()));
}

void readDiameter(GazeboReader* reader, const char* path, double* radius) {
  double diameter = 2 * *radius;
  reader->read(path, &diameter, NumberRange::positive());
  *radius = diameter / 2;
}

void readWay(GazeboReader* reader, DriveConfig* drive) {
  reader->read("commandTopic", &drive->command_topic);
  reader->read("odometryTopic", &drive->odom_topic);
  readFrame(reader, "odometryFrame", &drive->odom_frame);
  readFrame(reader, "robotBaseFrame", &drive->base_frame);
  reader->read("updateRate", &drive->publish_rate, NumberRange::notNegative());
  reader->skip({"alwaysOn", "rosDebugLevel"});
}

void readOdometrySource(GazeboReader* reader, DriveConfig* drive) {
  const std::string source = reader->text("odometrySource").value_or("world");
  if (source == "encoder")
    drive->source = DriveConfig::Odometry::ENCODER;
  else if (source != "world")
    reader->fault("odometrySource", fmt::format("'{}' is neither encoder nor world; it is world: write one of them", source));
}

void readSides(GazeboReader* reader, double separation, DriveConfig* drive) {
  drive->wheel_separation = separation;
  reader->read("wheelSeparation", &drive->wheel_separation, NumberRange::positive());
  readDiameter(reader, "wheelDiameter", &drive->wheel_radius);
}

void nameSides(ControllerConfig* config) {
  config->joints = config->drive.left;
  config->joints.insert(config->joints.end(), config->drive.right.begin(), config->drive.right.end());
}

void readDiffDrive(GazeboReader* reader, ControllerConfig* config) {
  DriveConfig* drive = &config->drive;
  readSides(reader, 0.34, drive);
  drive->left = {wheel(reader, "leftJoint", "left_joint")};
  drive->right = {wheel(reader, "rightJoint", "right_joint")};
  reader->read("wheelAcceleration", &drive->wheel_acceleration, NumberRange::notNegative());
  reader->read("wheelTorque", &drive->wheel_torque, NumberRange::positive());
  readFlag(reader, "publishOdomTF", &drive->enable_odom_tf);
  readOdometrySource(reader, drive);
  bool publishes = true, is_legacy = true;
  readFlag(reader, "publishTf", &publishes);
  if (!publishes) drive->publish_rate = RATE_OFF;
  readFlag(reader, "legacyMode", &is_legacy);
  if (is_legacy) {
    std::swap(drive->left, drive->right);
    reader->fault("legacyMode", "is not false, so leftJoint is the right wheel's, as in Gazebo: write false if left is left");
  }
  reader->skipWithoutEffect({"publishWheelTF", "publishWheelJointState"});
  nameSides(config);
}

void readSkidSteer(GazeboReader* reader, ControllerConfig* config) {
  DriveConfig* drive = &config->drive;
  readSides(reader, 0.4, drive);
  drive->left = {wheel(reader, "leftFrontJoint", "left_front_joint"), wheel(reader, "leftRearJoint", "left_rear_joint")};
  drive->right = {wheel(reader, "rightFrontJoint", "right_front_joint"), wheel(reader, "rightRearJoint", "right_rear_joint")};
  reader->read("torque", &drive->wheel_torque, NumberRange::positive());
  drive->enable_odom_tf = false;
  readFlag(reader, "broadcastTF", &drive->enable_odom_tf);
  drive->pose_covariance = {1e-4, 1e-4, 1e12, 1e12, 1e12, 0.01};
  reader->read("covariance_x", &drive->pose_covariance[0], NumberRange::notNegative());
  reader->read("covariance_y", &drive->pose_covariance[1], NumberRange::notNegative());
  reader->read("covariance_yaw", &drive->pose_covariance[5], NumberRange::notNegative());
  drive->twist_covariance = drive->pose_covariance;
  nameSides(config);
}

/** Its wheelAcceleration is one of angles, in front. */
void readTricycleAcceleration(GazeboReader* reader, DriveConfig* drive) {
  double speeding = 0;
  std::optional<double> slowing;
  reader->read("wheelAcceleration", &speeding, NumberRange::notNegative());
  reader->read("wheelDeceleration", &slowing, NumberRange::notNegative());
  drive->wheel_acceleration = speeding * drive->steering.steered_radius;
  if (slowing && *slowing != speeding)
    reader->fault("wheelDeceleration", "is not wheelAcceleration, which holds for both; write the same number");
}

void readTricycle(GazeboReader* reader, ControllerConfig* config) {
  config->kind = ControllerKind::STEERED_DRIVE;
  DriveConfig* drive = &config->drive;
  SteeringConfig& steering = drive->steering;
  steering.rear = {wheel(reader, "encoderWheelLeftJoint", "left_wheel_joint"),
                   wheel(reader, "encoderWheelRightJoint", "right_wheel_joint")};
  steering.joints = {wheel(reader, "steeringJoint", "front_steering_joint")};
  steering.driven = {wheel(reader, "actuatedWheelJoint", "front_wheel_joint")};
  steering.takes_angles = true;
  steering.steered_radius = drive->wheel_radius;
  readDiameter(reader, "actuatedWheelDiameter", &steering.steered_radius);
  readDiameter(reader, "encoderWheelDiameter", &drive->wheel_radius);
  reader->read("steeringSpeed", &steering.speed, NumberRange::notNegative());
  reader->read("wheelTorque", &drive->wheel_torque, NumberRange::positive());
  readTricycleAcceleration(reader, drive);
  readOdometrySource(reader, drive);
  if (!reader->text("robotBaseFrame")) drive->base_frame = "base_link";
  reader->skipWithoutEffect(
      {"encoderWheelSeparation", "wheelSpeedTolerance", "steeringAngleTolerance", "publishWheelTF", "publishWheelJointState"});
  config->joints = jointsOf(steering);
}

void readPlanarMove(GazeboReader* reader, ControllerConfig* config) {
  config->kind = ControllerKind::PLANAR_DRIVE;
  DriveConfig* drive = &config->drive;
  drive->publish_rate = 20;
  reader->read("odometryRate", &drive->publish_rate, NumberRange::positive());
  double timeout = -1;
  reader->read("cmdTimeout", &timeout, NumberRange::any());
  drive->cmd_vel_timeout = timeout < 0 ? 0 : std::max(timeout, SHORTEST_TIMEOUT);
}

struct DriveType {
  const char* plugin;
  void (*read)(GazeboReader* reader, ControllerConfig* config);
};
constexpr DriveType DRIVE_TYPES[] = {{"gazebo_ros_diff_drive", readDiffDrive},
                                     {"gazebo_ros_skid_steer_drive", readSkidSteer},
                                     {"gazebo_ros_tricycle_drive", readTricycle},
                                     {"gazebo_ros_planar_move", readPlanarMove}};

/** Why a wheel cannot be driven, in words; empty if it can. */
std::string faultOfWheel(const std::string& name, const std::vector<std::string>& wheels, const model::RobotModel& model) {
  const int index = model.jointIndex(name);
  if (index < 0) return unknownName("joint", name, model.joints);
  const model::JointModel& joint = model.joints[index];
  const bool turns = joint.type == model::JointType::CONTINUOUS || joint.type == model::JointType::REVOLUTE;
  if (!turns || joint.mimic) return fmt::format("joint '{}' {}", name, joint.mimic ? "mimics another one" : "is none that turns");
  return std::count(wheels.begin(), wheels.end(), name) > 1 ? fmt::format("joint '{}' is there twice", name) : "";
}

bool hasName(const std::vector<ControllerConfig>& controllers, const std::string& name) {
  return std::any_of(controllers.begin(), controllers.end(), [&](const ControllerConfig& other) { return other.name == name; });
}

/** Notes what is wrong with a drive. @return whether it can be used */
bool isUsable(const ControllerConfig& config, const RobotConfig& robot, const model::RobotModel& model, GazeboReader* reader) {
  if (config.kind == ControllerKind::PLANAR_DRIVE && robot.fixed_base) {
    reader->notes().fault(reader->where(), "the base is fixed, so nothing pushes it; the drive is left out");
    return false;
  }
  for (const std::string& name : config.joints) {
    const std::string why = faultOfWheel(name, config.joints, model);
    if (why.empty()) continue;
    reader->notes().fault(reader->where(), why + "; the drive is left out: correct it");
    return false;
  }
  for (const std::string& topic : {config.drive.command_topic, config.drive.odom_topic}) {
    if (!topic.empty() && isTopic(topic)) continue;
    reader->notes().fault(reader->where(), fmt::format("'{}' is no ROS topic; the drive is left out: use letters, digits, _ and /", topic));
    return false;
  }
  try {
    ControllerConfig measures = config;
    measures.drive = measured(config, model);
    undercarriageOf(measures, model);
  } catch (const InputError& error) {
    reader->notes().fault(reader->where(), fmt::format("{}; the drive is left out", error.what()));
    return false;
  }
  return true;
}

}  // namespace

bool readGazeboDrive(const model::GazeboBlock& plugin, const model::RobotModel& model, GazeboNotes* notes, RobotConfig* robot) {
  const std::string kind = pluginName(plugin.type);
  const auto type = std::find_if(std::begin(DRIVE_TYPES), std::end(DRIVE_TYPES), [&](const DriveType& row) { return kind == row.plugin; });
  if (type == std::end(DRIVE_TYPES)) return false;
  GazeboReader reader(plugin, notes);
  ControllerConfig config = gazebosDefaults(rosWord(plugin.name.empty() ? "drive" : plugin.name, "drive_"));
  DriveConfig& drive = config.drive;
  readWay(&reader, &drive);
  type->read(&reader, &config);
  const std::string name_space = reader.text("robotNamespace").value_or("");
  reader.finish();
  for (std::string* topic : {&drive.command_topic, &drive.odom_topic}) *topic = topicInBlock(*topic, name_space, robot->name_space);
  if (drive.odom_frame.empty()) drive.odom_frame = "odom";
  if (robot->controllers && hasName(*robot->controllers, config.name)) return true;
  if (robot->drives.size() >= MOST_DRIVES) {
    notes->fault(reader.where(), fmt::format("is one of more than {} drives; it is left out: give fewer", MOST_DRIVES));
  } else if (hasName(robot->drives, config.name)) {
    notes->fault(reader.where(), "is there twice; it is left out: rename it");
  } else if (isUsable(config, *robot, model, &reader)) {
    if (model.linkIndex(drive.base_frame) < 0)
      reader.fault("robotBaseFrame", unknownName("link", drive.base_frame, model.links) + "; the root link is taken: name one");
    notes->drive(fmt::format("{} (on {})", config.name, resolvedTopic(robot->name_space, drive.command_topic)));
    robot->drives.push_back(config);
  }
  return true;
}

}  // namespace blem_sim::sim
