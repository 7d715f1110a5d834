// Joints of a controller.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/sim/controller_config.h"
#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

/**
 * Indices into RobotInfo::joint_names of the joints that a controller is to have, in its order; of all with a motor if it names none.
 * @throws InputError: a joint is unknown or mimics another one
 */
std::vector<int> controlledJoints(const RobotInfo& robot, const ControllerConfig& config);

/** Index of the robot of a controller. @throws InputError: it was removed */
int controlledRobot(const Simulator& simulator, const ControllerConfig& config, const std::string& robot);

}  // namespace blem_sim::sim
