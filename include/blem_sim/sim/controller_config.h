// Settings of a controller: the keys of ros_controllers' joint_trajectory_controller and gripper_action_controller.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace blem_sim::sim {

/** Position errors [rad or m] that a joint may have; 0: any. */
struct JointConstraint {
  double trajectory = 0;  ///< on the way
  double goal = 0;        ///< at the end
};

enum class ControllerKind { TRAJECTORY, GRIPPER };

struct ControllerConfig {
  std::string name = "joint_trajectory_controller";
  ControllerKind kind = ControllerKind::TRAJECTORY;
  std::vector<std::string> joints;  ///< of a trajectory controller, empty: all that have a motor; of a gripper the one that its motor moves
  double action_monitor_rate = 20;  ///< [Hz] of the action's feedback; 0 = every step, RATE_OFF = never
  // Keys of trajectory controllers.
  double state_publish_rate = 50;            ///< [Hz]; 0 = every step, RATE_OFF = never
  double stop_trajectory_duration = 0;       ///< [s]; 0: an empty trajectory holds the actual position at once
  bool allow_partial_joints_goal = false;    ///< commands may leave joints out
  double goal_time = 0;                      ///< [s] after a trajectory's end, to reach the goal tolerances
  double stopped_velocity_tolerance = 0.01;  ///< [rad/s or m/s] of each joint at the end; 0: any
  std::map<std::string, JointConstraint> joint_constraints;
  // Keys of grippers.
  double goal_tolerance = 0.01;             ///< [m or rad]
  double stall_velocity_threshold = 0.001;  ///< [m/s or rad/s] up to which a gripper stands still
  double stall_timeout = 1;                 ///< [s] after which a gripper that stands still has stalled
};

/** Keys of a ControllerConfig of that kind; its name and kind apart. */
const std::vector<std::string>& controllerKeys(ControllerKind kind);

/**
 * Reads the keys that a node has over the settings given, which say the kind. @param source names the node in messages
 * @throws InputError for an unknown key, a wrong type or range
 */
ControllerConfig parseController(const YAML::Node& node, const std::string& source, ControllerConfig settings);

}  // namespace blem_sim::sim
