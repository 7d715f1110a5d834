// Wheels of which some are steered, each to its own angle, about one centre.
#pragma once

#include "wheels/undercarriage.h"

namespace blem_sim::sim {

/**
 * The wheels turn about a point on the line of the rear axle. A wheel steered by `angle` in the middle, a wheelbase L ahead of that axle's
 * middle (behind it: L < 0), stands for the others: it goes at a speed u along itself, the axle's middle at u cos(angle), and the base
 * turns at u sin(angle) / L. Places are those with all joints at 0.
 */
class SteeredWheels : public Undercarriage {
 public:
  /** @param config measured @throws InputError: the URDF has no such undercarriage */
  SteeredWheels(const ControllerConfig& config, const model::RobotModel& robot);

  double angleFor(const DriveTwist& wanted, double now) const override;
  std::vector<double> velocities(const DriveTwist& twist, const Steering& steering) const override;
  std::vector<double> positions(double angle) const override;
  double angleOf(const std::vector<dynamics::JointState>& joints) const override;
  DriveTwist rolled(const std::vector<dynamics::JointState>& joints) const override;

 private:
  /** Place of a steering axis on the base [m], ahead and to the left of the rear axle's middle. */
  struct Pin {
    double x = 0, y = 0;
  };
  struct Wheel {
    std::size_t joint = 0;  ///< among the controller's
    int pin = -1;           ///< that it turns about; -1: it is not steered
    double y = 0;           ///< [m] to the left of the rear axle's middle, or of its pin
    double radius = 0;      ///< [m]
  };

  void addWheels(const ControllerConfig& config, const model::RobotModel& robot);
  void addWheel(const std::string& name, const ControllerConfig& config, const model::RobotModel& robot);
  void addPins(const ControllerConfig& config, const model::RobotModel& robot);
  void boundAngle(const ControllerConfig& config, const model::RobotModel& robot);
  /** Angle in the middle [rad] for that of a steering joint, and back. */
  double middleAngle(const Pin& pin, double position) const;
  double positionOf(const Pin& pin, double angle) const;
  /** [m/s] at which a wheel's rim goes for each m/s of the axle's middle, and for each rad/s of the base. */
  DriveTwist rollingRates(const Wheel& wheel, double position) const;
  /** [m/s] of the wheel in the middle. */
  double speedFor(const DriveTwist& twist, const Steering& steering) const;

  std::vector<Pin> pins_;            ///< of the steering joints
  std::size_t steering_at_ = 0;      ///< place of the first of them among the controller's joints
  std::vector<Wheel> rolling_;       ///< rear wheels, and driven ones that are none
  std::vector<std::size_t> driven_;  ///< indices into rolling_ of wheels()
  double wheelbase_ = 0;             ///< [m]
  double least_ = 0, most_ = 0;      ///< [rad] in the middle
  bool takes_angles_ = false;
  bool pulls_ = false;  ///< all driven wheels are steered
};

}  // namespace blem_sim::sim
