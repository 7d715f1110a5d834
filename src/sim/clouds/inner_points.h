// Vertices of a live environment inside bodies.
#pragma once

#include <vector>

#include "build/simulated_world.h"
#include "clouds/fading_points.h"

namespace blem_sim::sim {

/** Vertices of a live environment that a body's lower side has come to lie above: what it stands on has risen into it. */
struct BuriedPoints {
  int body_collider;
  std::vector<int> vertices;  ///< sorted
  std::vector<double> ways;   ///< [m] straight down to the body's surface, of each
  std::vector<int> around;    ///< corners of what lies in the body's box, or less than a layer off; sorted
  double way = 0;             ///< [m] of the deepest
};

/** Vertices of a cloud or mesh inside bodies. */
struct InnerPoints {
  std::vector<SunkPoint> gone;       ///< sunk for good, in any order, some perhaps twice
  std::vector<BuriedPoints> buried;  ///< by collider
};

/**
 * Vertices of a static cloud or mesh inside closed meshes of bodies. Those that a camera sees of a robot itself are gone: a contact from
 * there would push inwards. Those whose way out is down, MOST_BURIED at most, are buried: the body stands on them. Inside is where a ray
 * meets the mesh an odd number of times.
 * @param bodies states at hand, by slot @param cloud collider @param up unit vector, or zero: nothing stands
 */
InnerPoints innerPoints(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, int cloud, const Vector3& up);

/** [m] Longest way down to a body's surface at which a vertex inside the body is buried. */
constexpr double MOST_BURIED = 0.02;

}  // namespace blem_sim::sim
