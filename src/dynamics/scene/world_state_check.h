// Whether the numbers of a state that comes from outside can be those of bodies.
#pragma once

#include "blem_sim/dynamics/world_types.h"
#include "scene/scene.h"

namespace blem_sim::dynamics {

/**
 * @throws InputError in one line: a number that is not finite, a body whose quaternion is not unit or whose rotation is another one, or
 * one farther or faster than 1e12 (m, m/s, rad/s)
 */
void checkNumbers(const Scene& scene, const WorldState& state);

}  // namespace blem_sim::dynamics
