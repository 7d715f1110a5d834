#include "controllers/controlled_joints.h"

#include <fmt/format.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"
#include "numbers/nearest_name.h"

namespace blem_sim::sim {
namespace {

std::vector<int> drivenJoints(const RobotInfo& robot) {
  std::vector<int> joints;
  for (std::size_t joint = 0; joint < robot.joint_names.size(); ++joint)
    if (robot.driven[joint]) joints.push_back(static_cast<int>(joint));
  return joints;
}

}  // namespace

std::vector<int> controlledJoints(const RobotInfo& robot, const ControllerConfig& config) {
  if (config.joints.empty()) return drivenJoints(robot);
  const std::string where = "controller '" + config.name + "': joints";
  std::vector<int> joints;
  for (const std::string& name : config.joints) {
    requireName(name, robot.joint_names, where, "movable joint");
    const auto joint = std::find(robot.joint_names.begin(), robot.joint_names.end(), name) - robot.joint_names.begin();
    if (!robot.driven[joint]) throw InputError(fmt::format("{}: '{}' mimics another joint and has no motor; leave it out", where, name));
    joints.push_back(static_cast<int>(joint));
  }
  return joints;
}

int controlledRobot(const Simulator& simulator, const ControllerConfig& config, const std::string& robot) {
  const int index = simulator.robotIndex(robot);
  if (index < 0) throw InputError(fmt::format("controller '{}': its robot '{}' was removed; make another controller", config.name, robot));
  return index;
}

}  // namespace blem_sim::sim
