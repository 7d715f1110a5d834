#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim::geometry {

/**
 * Turn of one direction into another by the shortest way; about any axis across where they are opposite. Directions may have any length
 * but zero. Eigen's FromTwoVectors does the same with a singular value decomposition, which takes a compiler some seconds in every file.
 */
inline Quaternion shortestTurn(const Vector3& from, const Vector3& to) {
  const Vector3 a = from.normalized(), sum = a + to.normalized();
  constexpr double OPPOSITE = 1e-12;
  if (sum.norm() < OPPOSITE) {
    const Vector3 axis = a.unitOrthogonal();
    return {0, axis.x(), axis.y(), axis.z()};
  }
  // Half the sum's square is one and the cosine, its product with `a` that of both, without their cancellation.
  const Vector3 axis = a.cross(sum);
  return Quaternion(0.5 * sum.squaredNorm(), axis.x(), axis.y(), axis.z()).normalized();
}

}  // namespace blem_sim::geometry
