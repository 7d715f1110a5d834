// Wheels and steering of a drive: its joints' motion for a twist, and the twist for its joints' motion.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/drive_controller.h"

namespace blem_sim::sim {

/** Angles [rad] of a steered wheel in the middle. */
struct Steering {
  double wanted = 0;
  double now = 0;
};

/** Wheels and steering joints of a drive, without a simulator. States of joints are those of ControllerConfig::joints, in their order. */
class Undercarriage {
 public:
  virtual ~Undercarriage() = default;

  const std::vector<std::string>& wheels() const { return wheels_; }      ///< joints with a motor that keeps velocities
  const std::vector<std::string>& steering() const { return steering_; }  ///< joints whose motors hold angles
  /** Place in the base [m] of the point whose motion the twists are. */
  const Eigen::Vector2d& middle() const { return middle_; }

  /** Steering angle [rad] for a twist that is wanted. @param now the angle that it has */
  virtual double angleFor(const DriveTwist& wanted, double now) const = 0;
  /** Velocities of wheels [rad/s]. @param twist within its limits */
  virtual std::vector<double> velocities(const DriveTwist& twist, const Steering& steering) const = 0;
  /** Positions [rad] of the steering joints. @param angle of a wheel in the middle */
  virtual std::vector<double> positions(double angle) const = 0;
  /** Steering angle [rad] that the joints have, the nearest that can be commanded. */
  virtual double angleOf(const std::vector<dynamics::JointState>& joints) const = 0;
  /** Motion of the middle over the ground, if no wheel slips. */
  virtual DriveTwist rolled(const std::vector<dynamics::JointState>& joints) const = 0;

 protected:
  std::vector<std::string> wheels_, steering_;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
};

/** @param config measured @throws InputError: wheels or joints that cannot be a drive's */
std::shared_ptr<const Undercarriage> undercarriageOf(const ControllerConfig& config, const model::RobotModel& robot);

}  // namespace blem_sim::sim
