// Motors of one robot: their settings from configuration and URDF, computed gains where none are given.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/sim/config.h"
#include "build/joint_loads.h"
#include "commands/joint_motor.h"

namespace blem_sim::sim {

/** Checks gains, friction, limits, armatures and initial positions. @throws InputError that names the field and the joint */
void checkMotors(const RobotConfig& config);

/** Motors of a robot and, in words, what was assumed for them. */
struct RobotMotors {
  std::vector<MotorSettings> settings;  ///< one per lumped joint
  std::vector<std::string> notes;
};

/** @param positions of the joints at the start; gravity: its size [m/s^2] */
RobotMotors robotMotors(const RobotConfig& config, const model::RobotModel& model, const model::LumpedRobot& robot,
                        const std::vector<double>& positions, double gravity);

}  // namespace blem_sim::sim
