#include "build/robot_names.h"

#include <fmt/format.h>

#include <set>

#include "blem_sim/geometry/input_error.h"
#include "numbers/nearest_name.h"

namespace blem_sim::sim {
namespace {

struct Names {
  std::vector<std::string> links, movable, all_joints;
};

Names namesOf(const model::RobotModel& model, const model::LumpedRobot& lumped) {
  Names names;
  for (const model::LinkModel& link : model.links) names.links.push_back(link.name);
  for (const model::JointModel& joint : model.joints) names.all_joints.push_back(joint.name);
  for (const model::LumpedJoint& joint : lumped.joints)
    if (joint.moves()) names.movable.push_back(joint.name);
  return names;
}

template <typename Value>
void checkJoints(const std::map<std::string, Value>& by_joint, const std::string& where, const std::vector<std::string>& movable,
                 bool with_default) {
  for (const auto& entry : by_joint)
    if (!with_default || entry.first != "default") requireName(entry.first, movable, where, "movable joint");
}

void checkSensor(const SensorConfig& sensor, const std::string& where, const Names& names, const model::RobotModel& model) {
  switch (sensor.type) {
    case SensorType::FORCE_TORQUE: {
      requireName(sensor.joint, names.all_joints, where + ": joint", "joint");
      const model::JointType type = model.joints[model.jointIndex(sensor.joint)].type;
      if (type == model::JointType::FLOATING || type == model::JointType::PLANAR)
        throw InputError(
            fmt::format("{}: joint: '{}' is a floating or planar joint, which carries no wrench; take another", where, sensor.joint));
      std::vector<std::string> frames = {"child", "parent", "sensor"};
      frames.insert(frames.end(), names.links.begin(), names.links.end());
      requireName(sensor.frame, frames, where + ": frame", "frame");
      requireName(sensor.measure, {"parent_to_child", "child_to_parent"}, where + ": measure", "direction");
      return;
    }
    case SensorType::IMU:
    case SensorType::CONTACT:
    case SensorType::CONTACT_SWITCH:
    case SensorType::CENTRE_OF_PRESSURE:
    case SensorType::TILT:
    case SensorType::ODOMETRY:
    case SensorType::DEPTH_CAMERA:
    case SensorType::LIDAR:
      requireName(sensor.link, names.links, where + ": link", "link");
      return;
    case SensorType::MOTOR_CURRENT:
      checkJoints(sensor.torque_constant, where + ": torque_constant", names.movable, true);
      return;
  }
}

}  // namespace

void checkRobotNames(const RobotConfig& config, const model::RobotModel& model, const model::LumpedRobot& lumped) {
  const Names names = namesOf(model, lumped);
  const std::string where = "robots: " + config.name + ": ";
  checkJoints(config.initial_positions, where + "initial_positions", names.movable, false);
  checkJoints(config.gains, where + "gains", names.movable, true);
  checkJoints(config.motor, where + "motor", names.movable, true);
  checkJoints(config.joint_friction, where + "joint_friction", names.movable, true);
  checkJoints(config.effort_limits, where + "effort_limits", names.movable, true);
  checkJoints(config.velocity_limits, where + "velocity_limits", names.movable, true);
  checkJoints(config.armature, where + "armature", names.movable, true);
  for (const std::string& link : config.self_colliding_links) requireName(link, names.links, where + "self_colliding_links", "link");
  for (const auto& entry : config.links) requireName(entry.first, names.links, where + "links", "link");
  for (const auto& pair : config.disable_collisions)
    for (const std::string& link : {pair.first, pair.second}) requireName(link, names.links, where + "disable_collisions", "link");
  std::set<std::string> sensor_names;
  for (const SensorConfig& sensor : config.sensors) {
    if (!sensor_names.insert(sensor.name).second)
      throw InputError(fmt::format("{}sensors: '{}' is there twice; give each its own name", where, sensor.name));
    checkSensor(sensor, where + "sensors: " + sensor.name, names, model);
  }
}

}  // namespace blem_sim::sim
