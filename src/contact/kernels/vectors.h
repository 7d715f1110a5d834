// Between Eigen and the kernels' plain numbers.
#pragma once

#include "blem_sim/geometry/types.h"
#include "kernels/records.h"

namespace blem_sim::contact {

inline Vector3 vector3(const kernels::Vec4& v) { return {v.x, v.y, v.z}; }
inline kernels::Vec4 vec4(const Vector3& v, double w) { return {v.x(), v.y(), v.z(), w}; }

/** Rotation and translation as the kernels take them. */
inline kernels::Motion motionOf(const Pose& X) {
  kernels::Motion motion;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(motion.R) = X.linear();
  Eigen::Map<Vector3>(motion.t) = X.translation();
  return motion;
}

}  // namespace blem_sim::contact
