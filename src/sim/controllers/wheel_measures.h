// Measures of a drive's wheels that its configuration leaves to the URDF.
#pragma once

#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/controller_config.h"

namespace blem_sim::sim {

/**
 * Separation and radius of a drive's wheels with their factors, as diff_drive_controller takes them: what is 0 is the distance of the first
 * two axles, and the radius of the first left wheel's collision shape.
 * @param drive its wheels are joints of the robot's description @throws InputError: the URDF does not say it
 */
DriveConfig measured(const ControllerConfig& controller, const model::RobotModel& robot);

}  // namespace blem_sim::sim
