// What a state belongs to: everything that decides what its numbers mean and how a step goes on from them.
#pragma once

#include <string>

#include "simulated_world.h"

namespace blem_sim {

/**
 * Settings, models, bodies, joints, colliders and sensors, a line each: what it is, a tab, and the hash of what it holds (masses, inertias,
 * limits, gains, surfaces, vertices and triangles). Colliders come with their slots, as contacts are known by them.
 */
std::string layoutOf(const SimulationConfig& config, const SimulatedWorld& world);

/** @throws InputError in one line that says what differs first */
void checkLayout(const std::string& saved, const std::string& here);

}  // namespace blem_sim
