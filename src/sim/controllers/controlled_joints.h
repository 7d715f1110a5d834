// Joints of a controller.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/sim/controller_config.h"
#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::sim {

/**
 * Indices into RobotInfo::joint_names of the joints that a controller is to have, in its order; of all with a motor if it names none.
 * @throws InputError: a joint is unknown or mimics another one
 */
std::vector<int> controlledJoints(const RobotInfo& robot, const ControllerConfig& config);

}  // namespace blem_sim::sim
