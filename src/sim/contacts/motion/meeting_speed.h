// Speed of two colliders against each other where they may meet.
#pragma once

#include <vector>

#include "build/simulated_world.h"

namespace blem_sim::sim {

/**
 * Largest relative speed of the points that are within the pair's margin of both colliders' layers, whatever its direction; over a
 * half-space the largest one towards its plane.
 * @param bodies their states, by slot @param motion poses of the colliders
 * @return [m/s] at least 0
 */
double meetingSpeed(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                    const std::vector<contact::ColliderMotion>& motion, const contact::ColliderPair& pair);

/** No less than that, for a fraction of its cost. */
double meetingSpeedBound(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                         const std::vector<contact::ColliderMotion>& motion, const contact::ColliderPair& pair);

}  // namespace blem_sim::sim
