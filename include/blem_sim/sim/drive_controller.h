// A robot on wheels that is driven by twists and tells of its way, with diff_drive_controller's semantics, without ROS.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/sim/controller_config.h"
#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

/** Motion over the ground. */
struct DriveTwist {
  double linear = 0;   ///< [m/s] ahead
  double angular = 0;  ///< [rad/s] to the left
};

/** Pose and velocity of the base. */
struct DriveOdometry {
  Pose X_OB = Pose::Identity();    ///< in the frame of odometry: where the encoder's began, or the world
  Vector3 v_OB = Vector3::Zero();  ///< [m/s] in the base's axes
  Vector3 w_OB = Vector3::Zero();  ///< [rad/s] the same
};

/**
 * Turns twists into velocities of wheels, which their motors keep as exactly as their efforts allow. Twists change within their limits,
 * each wheel's rim at wheel_acceleration at most. Commands come between two steps.
 */
class DriveController {
 public:
  /** @throws InputError: no such joint, one that has no motor, one that is there twice */
  DriveController(Simulator* simulator, int robot, ControllerConfig config);

  const ControllerConfig& config() const { return config_; }
  int robot() const;                  ///< @throws InputError: it was removed
  int base() const { return base_; }  ///< link of the robot's description
  bool running() const { return running_; }

  /** Stops the wheels; commands are taken from now on, and the encoder's odometry begins here. */
  void start();
  /** The wheels stop. */
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
  const RobotInfo& robotInfo() const { return simulator_->robots()[robot()]; }
  struct Memory;
  /** A drive that stands still since the present step. */
  Memory atRest() const;
  /** The simulator's memory; if there is none, that the drive begins now. */
  Memory recall() const;
  void keep(const Memory& memory);
  /** The wheels stop, and the encoder's odometry begins here. */
  void restart();
  /** Takes a wanted twist. @throws InputError: nothing is changed then */
  void want(const DriveTwist& twist, Memory* memory);
  /** Speeds of a step later. */
  void changeSpeeds(Memory* memory) const;
  /** Turns the wheels, from the next step on. */
  void drive(const DriveTwist& twist);
  /** Whether motors of wheels have a velocity to keep. */
  bool isCommanded() const;
  bool isTakenOver() const;
  /** [m/s] of the rims of some wheels, their mean. @param first index into joints_ */
  double rimSpeed(std::size_t first, std::size_t count) const;
  DriveTwist rolled() const;
  /** Adds the way of a step. */
  void roll(Memory* memory) const;
  DriveOdometry worldOdometry() const;

  Simulator* simulator_;
  std::string robot_;  ///< its index may change when others come or go
  ControllerConfig config_;
  std::vector<int> joints_;  ///< indices into RobotInfo::joint_names, left wheels first
  int base_ = 0;
  bool running_ = false;
};

}  // namespace blem_sim::sim
