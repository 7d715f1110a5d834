#pragma once

#include <blem_sim/ODEPhysics.h>

#include <string>

#include "blem_sim/sim/config.h"

namespace blem_sim::node {

/** Settings that Gazebo's message has a name for; those without a meaning here are 0. */
ODEPhysics toOdePhysics(const sim::SimulationConfig& config);

/** Names of the settings that are given and differ from the configuration's, with blanks between; a message of zeros gives none. */
std::string differencesIn(const ODEPhysics& given, const sim::SimulationConfig& config);

}  // namespace blem_sim::node
