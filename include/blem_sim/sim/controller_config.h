// Settings of a controller: the keys of ros_controllers' joint_trajectory_controller, gripper_action_controller, diff_drive_controller and
// ackermann_steering_controller.
#pragma once

#include <array>
#include <limits>
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

enum class ControllerKind { TRAJECTORY, GRIPPER, DRIVE, STEERED_DRIVE, PLANAR_DRIVE };

/** True for what takes twists and gives odometry. */
inline bool isDrive(ControllerKind kind) {
  return kind == ControllerKind::DRIVE || kind == ControllerKind::STEERED_DRIVE || kind == ControllerKind::PLANAR_DRIVE;
}

/** Limits of a part of a drive's twist, of both signs; infinite: none. Units as that part's: [m] or [rad]. */
struct SpeedLimits {
  static constexpr double NONE = std::numeric_limits<double>::infinity();
  double min_velocity = -NONE, max_velocity = NONE;          ///< [1/s]
  double min_acceleration = -NONE, max_acceleration = NONE;  ///< [1/s^2]
  double min_jerk = -NONE, max_jerk = NONE;                  ///< [1/s^3]
};

/** Settings of a drive that turns by steering wheels, as cars and tricycles do. Angles are positive to the left. */
struct SteeringConfig {
  std::vector<std::string> rear;    ///< joints of the wheels that are not steered
  std::vector<std::string> joints;  ///< that steer
  std::vector<std::string> driven;  ///< joints of the wheels with a motor, rear or steered ones
  double wheelbase = 0;             ///< [m] from the rear wheels' middle to the steering joints; 0: as the URDF has them
  double wheelbase_multiplier = 1;  ///< factor of calibration
  double steered_radius = 0;        ///< [m] of driven wheels that are steered; 0: that of the first one's cylinder or sphere
  double max_angle = 0;             ///< [rad] to both sides, of a wheel in the middle; 0: as far as the joints' limits let it
  double speed = 0;                 ///< [rad/s] of that wheel; 0: any
  /** Commands are a steering angle [rad] in the place of angular.z, and the speed of the driven wheels' middle [m/s]. */
  bool takes_angles = false;
};

/** Settings of a drive: a robot on wheels that turns by letting the left ones roll otherwise than the right ones, or by steering; or one
 * that is pushed over the ground from outside, without wheels. */
struct DriveConfig {
  enum class Odometry { ENCODER, WORLD };
  std::vector<std::string> left, right;  ///< joints of the wheels of a drive that does not steer
  SteeringConfig steering;               ///< of one that does
  double wheel_separation = 0;           ///< [m] between the middles of left and right wheels; 0: as the URDF has them
  double wheel_radius = 0;               ///< [m] at which they roll; 0: that of the first left or rear wheel's cylinder or sphere
  double separation_multiplier = 1, radius_multiplier = 1;  ///< factors of calibration
  SpeedLimits linear, angular;                              ///< of the twists that are driven
  SpeedLimits lateral;                                      ///< of their part to the left, of a drive without wheels
  double max_force = 0, max_torque = 0;                     ///< of a drive without wheels, as BaseVelocityCommand has them
  double wheel_acceleration = 0;                            ///< [m/s^2] of each wheel's rim; 0: any
  double wheel_torque = 0;                                  ///< [N m] of each wheel's motor at most, beside its own limit; 0: that alone
  double cmd_vel_timeout = 0.5;                             ///< [s] simulated after the last command, when the wheels stop; 0: never
  std::string command_topic;                                ///< in the robot's namespace; empty: cmd_vel below the controller's name
  std::string odom_topic;                                   ///< the same; empty: odom below the controller's name
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";  ///< link that odometry tells of; the root link if there is none of that name
  double publish_rate = 50;              ///< [Hz] of the odometry; 0 = every step, RATE_OFF = never
  bool enable_odom_tf = true;            ///< /tf has the base in the frame of its odometry, and not in the world
  Odometry source = Odometry::ENCODER;
  std::array<double, 6> pose_covariance = {1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3};   ///< diagonal [m^2, rad^2]
  std::array<double, 6> twist_covariance = {1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3};  ///< [(m/s)^2, (rad/s)^2]
};

struct ControllerConfig {
  std::string name = "joint_trajectory_controller";
  ControllerKind kind = ControllerKind::TRAJECTORY;
  /** Joints that it moves: of a trajectory controller all that have a motor if empty, of a gripper one, of a drive its wheels and what
   * steers them. */
  std::vector<std::string> joints;
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
  DriveConfig drive;
};

/** Rear wheels, steering joints and other driven wheels of a drive that steers. */
std::vector<std::string> jointsOf(const SteeringConfig& steering);

/** Topics of a drive in its robot's namespace. */
std::string commandTopic(const ControllerConfig& drive);
std::string odometryTopic(const ControllerConfig& drive);

/** Keys of a ControllerConfig of that kind; its name and kind apart. */
const std::vector<std::string>& controllerKeys(ControllerKind kind);

/**
 * Reads the keys that a node has over the settings given, which say the kind. @param source names the node in messages
 * @throws InputError for an unknown key, a wrong type or range
 */
ControllerConfig parseController(const YAML::Node& node, const std::string& source, ControllerConfig settings);

}  // namespace blem_sim::sim
