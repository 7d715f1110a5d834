// A robot on wheels that is driven by twists and tells of its way, as diff_drive_controller and ackermann_steering_controller do, without
// ROS.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "blem_sim/sim/controller_config.h"
#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

class Undercarriage;

/** Motion over the ground. */
struct DriveTwist {
  double linear = 0;   ///< [m/s] ahead
  double angular = 0;  ///< [rad/s] to the left; as a command to a drive that takes angles, [rad] of its steering
  double lateral = 0;  ///< [m/s] to the left, for a drive without wheels; others leave it out
};

/** Pose and velocity of the base. */
struct DriveOdometry {
  Pose X_OB = Pose::Identity();    ///< in the frame of odometry: where the encoder's began, or the world
  Vector3 v_OB = Vector3::Zero();  ///< [m/s] in the base's axes
  Vector3 w_OB = Vector3::Zero();  ///< [rad/s] the same
};

/**
 * Turns twists into velocities of wheels, which their motors keep as exactly as their efforts allow, and into angles of the joints that
 * steer, which their motors hold by their gains. Twists change within their limits, each wheel's rim at wheel_acceleration at most.
 * A drive without wheels has its base pushed from outside instead, while it runs (Simulator::driveBase).
 * Commands come between two steps.
 */
class DriveController {
 public:
  /** @throws InputError: no such joint, one that has no motor, one that is there twice, measures that are missing */
  DriveController(Simulator* simulator, int robot, ControllerConfig config);

  const ControllerConfig& config() const { return config_; }
  int robot() const;                  ///< @throws InputError: it was removed
  int base() const { return base_; }  ///< link of the robot's description
  bool running() const { return running_; }
  /** Joints, or the root link of a robot that is pushed: no other running controller may have them. */
  std::vector<std::string> claims() const;

  /** Stops the wheels; commands are taken from now on, and the encoder's odometry begins here. What takes angles steers straight. */
  void start();
  /** The wheels stop; steering stays as it is. Nothing pushes the base any more. */
  void stop();
  /** @throws InputError: stopped, no finite number, wheels would turn faster than can be commanded; nothing is changed then */
  void command(const DriveTwist& twist);
  /**
   * To be called after each step, a reset and a restored state. A command of an age of cmd_vel_timeout ends. Wheels that were reset, or
   * sent to a position by others, are the drive's again: they stop, and the encoder's odometry begins anew. A restored state has the
   * encoder's odometry and the age of the command; one that was saved without this drive has neither: they begin then.
   */
  void update();
  DriveOdometry odometry() const;

 private:
  bool isPlanar() const { return config_.kind == ControllerKind::PLANAR_DRIVE; }
  const RobotInfo& robotInfo() const { return simulator_->robots()[robot()]; }
  struct Memory;
  /** A drive that stands still since the present step. */
  Memory atRest() const;
  /** The simulator's memory; if there is none, that the drive begins now. */
  Memory recall() const;
  void keep(const Memory& memory);
  /** The wheels stop, and the encoder's odometry begins here. */
  void restart();
  /** The nearest twist within the limits. */
  DriveTwist allowed(const DriveTwist& twist) const;
  /** @throws InputError: wheels would have to turn too fast in the end */
  void requireCommandable(const DriveTwist& twist, Memory memory) const;
  /** Takes a wanted twist. */
  void want(const DriveTwist& twist, Memory* memory);
  /** Steering angle [rad] that is wanted. */
  double wantedAngle(const Memory& memory) const;
  /** Speeds and steering of a step later. */
  void changeSpeeds(Memory* memory) const;
  /** Whether the next step's are others. */
  bool isUnderWay(const Memory& memory) const;
  /** Velocities of wheels [rad/s]. */
  std::vector<double> velocities(const Memory& memory) const;
  /** Turns the wheels, from the next step on. */
  void drive(const std::vector<double>& velocities);
  /** Pushes the base, from the next step on. */
  void push(const Memory& memory);
  void steer(double angle);
  /** Whether motors of wheels, or the base, have a velocity to keep. */
  bool isCommanded() const;
  bool isTakenOver() const;
  std::vector<dynamics::JointState> jointStates() const;
  DriveTwist rolled() const;
  /** Adds the way of a step. */
  void roll(Memory* memory) const;
  DriveOdometry worldOdometry() const;

  Simulator* simulator_;
  std::string robot_;  ///< its index may change when others come or go
  ControllerConfig config_;
  std::vector<int> joints_;  ///< indices into RobotInfo::joint_names, in the configuration's order
  std::vector<int> wheels_;  ///< of them those that the drive turns
  std::shared_ptr<const Undercarriage> undercarriage_;
  int base_ = 0;
  bool running_ = false;
};

}  // namespace blem_sim::sim
