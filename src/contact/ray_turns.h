// Directions of rays in other frames, each number by the same operations in the same order as in the kernels.
#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim::contact {

inline Vector3 turned(const Matrix3& R, const Vector3& d) {
  const auto row = [&](int i) { return R(i, 0) * d.x() + R(i, 1) * d.y() + R(i, 2) * d.z(); };
  return {row(0), row(1), row(2)};
}

}  // namespace blem_sim::contact
