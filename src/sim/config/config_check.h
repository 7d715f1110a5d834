// Checks of a configuration made by hand, for values that no YAML could give it.
#pragma once

#include "blem_sim/sim/config.h"

namespace blem_sim::sim {

/** @throws InputError that names the field and the cure: a number that is none, or out of its range. The loaders check files and robots'
 * joints. */
void checkConfig(const SimulationConfig& config);
void checkEnvironment(const EnvironmentConfig& environment);
void checkRobot(const RobotConfig& robot);

}  // namespace blem_sim::sim
