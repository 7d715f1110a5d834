// What a configuration made by hand may hold though no YAML could.
#pragma once

#include "blem_sim/sim/config.h"

namespace blem_sim {

/** @throws InputError that names the field and the cure: a number that is none, or out of its range. Files and robots' joints are checked
 * where they are loaded. */
void checkConfig(const SimulationConfig& config);
void checkEnvironment(const EnvironmentConfig& environment);

}  // namespace blem_sim
