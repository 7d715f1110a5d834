// Layout of a state: everything that decides the meaning of its numbers and how a step goes on from them.
#pragma once

#include <string>

#include "build/simulated_world.h"

namespace blem_sim::sim {

/**
 * Settings, models, bodies, joints, colliders and sensors, line by line: a name, a tab, and the hash of the content (masses, inertias,
 * limits, gains, surfaces, vertices and triangles). Colliders come with their slots, as contacts are known by them.
 */
std::string layoutOf(const SimulationConfig& config, const SimulatedWorld& world);

/** @throws InputError in one line that names the first difference */
void checkLayout(const std::string& saved, const std::string& here);

}  // namespace blem_sim::sim
