#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "config/config_sections.h"

namespace blem_sim::sim {

namespace {

const std::vector<std::string> DIFFERENTIAL_KEYS = {"left_wheel", "right_wheel", "wheel_separation", "wheel_separation_multiplier"};
const std::vector<std::string> STEERED_KEYS = {
    "rear_wheel",         "front_steer",        "driven_wheel",   "wheel_separation_h",      "wheel_separation_h_multiplier",
    "front_wheel_radius", "max_steering_angle", "steering_speed", "cmd_angle_instead_rotvel"};
const std::vector<std::string> WHEEL_KEYS = {"wheel_radius", "wheel_radius_multiplier", "wheel_acceleration", "wheel_torque",
                                             "odometry_source"};
const std::vector<std::string> PLANAR_KEYS = {"max_force", "max_torque"};
const std::vector<std::string> COMMON_KEYS = {"linear",
                                              "angular",
                                              "cmd_vel_timeout",
                                              "cmd_vel_topic",
                                              "odom_topic",
                                              "odom_frame_id",
                                              "base_frame_id",
                                              "publish_rate",
                                              "enable_odom_tf",
                                              "pose_covariance_diagonal",
                                              "twist_covariance_diagonal"};

std::vector<std::string> joined(std::vector<std::string> keys, const std::vector<std::string>& others) {
  keys.insert(keys.end(), others.begin(), others.end());
  return keys;
}

/** One name or a list of them. @param missing what to say where there is none */
void readWheels(YamlReader& reader, const std::string& key, const std::string& missing, std::vector<std::string>* wheels) {
  const YAML::Node given = reader.node(key);
  const std::string wanted = "must be a joint, or a list of them: [front, rear]";
  if (!given.IsDefined() && !wheels->empty()) return;
  if (!given.IsDefined()) reader.refuse(key, "is missing; " + missing);
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
  readCovariance(reader, "pose_covariance_diagonal", &drive->pose_covariance);
  readCovariance(reader, "twist_covariance_diagonal", &drive->twist_covariance);
}

/** A limit's two ends; the lower one is minus the upper one if it is left out. Both are read, whether they hold or not. */
void readLimit(YamlReader& reader, const std::string& name, double* lower, double* upper) {
  bool holds = false;
  std::optional<double> least, most;
  reader.read("has_" + name + "_limits", &holds);
  reader.read("max_" + name, &most, NumberRange::notNegative());
  reader.read("min_" + name, &least, NumberRange::notPositive());
  if (!holds) return;
  if (!most) reader.refuse("max_" + name, "is missing; give it, or has_" + name + "_limits: false");
  *upper = *most;
  *lower = least.value_or(-*most);
}

/** Limits of one part of twists, as diff_drive_controller has them. */
void readTwistLimits(YamlReader& twist, const std::string& axis, SpeedLimits* limits) {
  YamlReader reader = twist.section(axis);
  readLimit(reader, "velocity", &limits->min_velocity, &limits->max_velocity);
  readLimit(reader, "acceleration", &limits->min_acceleration, &limits->max_acceleration);
  readLimit(reader, "jerk", &limits->min_jerk, &limits->max_jerk);
  reader.finish();
}

void readTwist(YamlReader& controller, bool sideways, DriveConfig* drive) {
  YamlReader linear = controller.section("linear"), angular = controller.section("angular");
  readTwistLimits(linear, "x", &drive->linear);
  if (sideways) readTwistLimits(linear, "y", &drive->lateral);
  readTwistLimits(angular, "z", &drive->angular);
  linear.finish();
  angular.finish();
}

void readWheelSides(YamlReader& reader, DriveConfig* drive) {
  const std::string missing = "name the joints of the wheels on that side";
  readWheels(reader, "left_wheel", missing, &drive->left);
  readWheels(reader, "right_wheel", missing, &drive->right);
  reader.read("wheel_separation", &drive->wheel_separation, NumberRange::positive());
  reader.read("wheel_separation_multiplier", &drive->separation_multiplier, NumberRange::positive());
}

void readSteering(YamlReader& reader, SteeringConfig* steering) {
  readWheels(reader, "rear_wheel", "name the joints of the wheels that are not steered", &steering->rear);
  readWheels(reader, "front_steer", "name the joints that steer", &steering->joints);
  if (steering->driven.empty()) steering->driven = steering->rear;
  readWheels(reader, "driven_wheel", "", &steering->driven);
  reader.read("wheel_separation_h", &steering->wheelbase, NumberRange::positive());
  reader.read("wheel_separation_h_multiplier", &steering->wheelbase_multiplier, NumberRange::positive());
  reader.read("front_wheel_radius", &steering->steered_radius, NumberRange::positive());
  reader.read("max_steering_angle", &steering->max_angle, NumberRange::positive());
  reader.read("steering_speed", &steering->speed, NumberRange::notNegative());
  reader.read("cmd_angle_instead_rotvel", &steering->takes_angles);
}

void readWheeledDrive(YamlReader& reader, ControllerConfig* config) {
  DriveConfig& drive = config->drive;
  if (config->kind == ControllerKind::STEERED_DRIVE) {
    readSteering(reader, &drive.steering);
    config->joints = jointsOf(drive.steering);
  } else {
    readWheelSides(reader, &drive);
    config->joints = drive.left;
    config->joints.insert(config->joints.end(), drive.right.begin(), drive.right.end());
  }
  reader.read("wheel_radius", &drive.wheel_radius, NumberRange::positive());
  reader.read("wheel_radius_multiplier", &drive.radius_multiplier, NumberRange::positive());
  reader.read("wheel_acceleration", &drive.wheel_acceleration, NumberRange::notNegative());
  reader.read("wheel_torque", &drive.wheel_torque, NumberRange::notNegative());
  if (const auto source = reader.choice("odometry_source", {"encoder", "world"}))
    drive.source = static_cast<DriveConfig::Odometry>(*source);
}

void readPlanarDrive(YamlReader& reader, DriveConfig* drive) {
  drive->source = DriveConfig::Odometry::WORLD;
  reader.read("max_force", &drive->max_force, NumberRange::notNegative());
  reader.read("max_torque", &drive->max_torque, NumberRange::notNegative());
}

}  // namespace

void readDrive(YamlReader& reader, ControllerConfig* config) {
  DriveConfig& drive = config->drive;
  const bool planar = config->kind == ControllerKind::PLANAR_DRIVE;
  if (planar)
    readPlanarDrive(reader, &drive);
  else
    readWheeledDrive(reader, config);
  readTwist(reader, planar, &drive);
  reader.read("cmd_vel_timeout", &drive.cmd_vel_timeout, NumberRange::notNegative());
  reader.read("cmd_vel_topic", &drive.command_topic);
  readDriveOdometry(reader, &drive);
}

const std::vector<std::string>& driveKeys(ControllerKind kind) {
  static const std::vector<std::string> wheeled = joined(WHEEL_KEYS, COMMON_KEYS), differential = joined(DIFFERENTIAL_KEYS, wheeled),
                                        steered = joined(STEERED_KEYS, wheeled), planar = joined(PLANAR_KEYS, COMMON_KEYS);
  if (kind == ControllerKind::PLANAR_DRIVE) return planar;
  return kind == ControllerKind::STEERED_DRIVE ? steered : differential;
}

std::vector<std::string> jointsOf(const SteeringConfig& steering) {
  std::vector<std::string> joints = steering.rear;
  joints.insert(joints.end(), steering.joints.begin(), steering.joints.end());
  std::copy_if(steering.driven.begin(), steering.driven.end(), std::back_inserter(joints), [&](const std::string& wheel) {
    return std::find(steering.rear.begin(), steering.rear.end(), wheel) == steering.rear.end();
  });
  return joints;
}

std::string commandTopic(const ControllerConfig& drive) {
  return drive.drive.command_topic.empty() ? drive.name + "/cmd_vel" : drive.drive.command_topic;
}

std::string odometryTopic(const ControllerConfig& drive) {
  return drive.drive.odom_topic.empty() ? drive.name + "/odom" : drive.drive.odom_topic;
}

}  // namespace blem_sim::sim
