// Shapes in a surveyor's coordinates.
#pragma once

#include <algorithm>

#include "blem_sim/geometry/types.h"

namespace blem_sim::geometry {

/** [m] from the origin, beyond which floats step by 0.06 mm and more. */
constexpr double FAR_AWAY = 1000;

/** [m] from the origin, beyond which no pose is taken: doubles step by 2 nm there, and surveyors' maps end before. */
constexpr double FARTHEST_PLACE = 1e7;

/** [m] Whole numbers near the middle of a shape that lies farther than FAR_AWAY, and than its own size, from the origin: taking them off
 * rounds nothing. Else zero. */
inline Vector3 farOrigin(const Box& bounds) {
  if (bounds.isEmpty()) return Vector3::Zero();
  const Vector3 middle = bounds.center();
  return middle.norm() > std::max(FAR_AWAY, bounds.diagonal().norm()) ? Vector3(middle.array().round()) : Vector3::Zero();
}

}  // namespace blem_sim::geometry
