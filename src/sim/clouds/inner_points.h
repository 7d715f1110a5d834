// Vertices of a live environment inside bodies.
#pragma once

#include <vector>

#include "build/simulated_world.h"
#include "clouds/fading_points.h"

namespace blem_sim::sim {

/**
 * Vertices of a static cloud or mesh inside closed meshes of bodies, as those that a camera sees of a robot itself: a contact from there
 * would push inwards. Inside is where a ray meets the mesh an odd number of times.
 * @param bodies states at hand, by slot @param cloud collider @return sunk for good, in any order, some perhaps twice
 */
std::vector<SunkPoint> innerPoints(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, int cloud);

}  // namespace blem_sim::sim
