// Measures of a drive's wheels that its configuration leaves to the URDF.
#pragma once

#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/controller_config.h"

namespace blem_sim::sim {

/** Index of the joint whose child a link is; -1 for the root. */
int jointAbove(int link, const model::RobotModel& robot);

/** Index of the steering joint that a joint is or hangs on; -1 if there is none. */
int steeringAbove(int joint, const SteeringConfig& steering, const model::RobotModel& robot);

/**
 * Place of a joint on a drive's base [m], ahead and to the left of its origin, all joints at 0.
 * @throws InputError: the URDF has no such joint
 */
Eigen::Vector2d placeInBase(const std::string& joint, const ControllerConfig& controller, const model::RobotModel& robot);

/**
 * Separation and radii of a drive's wheels with their factors, as diff_drive_controller takes them: what is 0 is the distance of the first
 * two axles, and the radius of the first wheel's collision shape: of the left, rear or steered ones.
 * @throws InputError: wheels are not named, or the URDF does not say it
 */
DriveConfig measured(const ControllerConfig& controller, const model::RobotModel& robot);

}  // namespace blem_sim::sim
