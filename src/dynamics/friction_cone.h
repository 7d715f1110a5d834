// Closed-form projection onto Coulomb's cone in a diagonal norm.
#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim {

/** Impulse of one contact and how it changes with the relative velocity; components (normal, tangent, tangent). */
struct ConeProjection {
  Vector3 impulse = Vector3::Zero();    ///< P(y)
  Matrix3 stiffness = Matrix3::Zero();  ///< -d impulse / d u = dP/dy * diag(1/w), symmetric, positive semidefinite
};

/**
 * Nearest point g to y in the cone |g_t| <= mu g_n, measured by w_n (g_n - y_n)^2 + w_t |g_t - y_t|^2.
 * @param with_stiffness also fill the derivative
 */
inline ConeProjection projectOnCone(const Vector3& y, double mu, double w_n, double w_t, bool with_stiffness) {
  ConeProjection out;
  const double slip = std::hypot(y.y(), y.z());
  if (slip <= mu * y.x()) {  // sticks
    out.impulse = y;
    if (with_stiffness) out.stiffness.diagonal() << 1 / w_n, 1 / w_t, 1 / w_t;
    return out;
  }
  if (w_n * y.x() + mu * w_t * slip <= 0) return out;  // open
  const double d = w_n + mu * mu * w_t;
  const double normal = (w_n * y.x() + mu * w_t * slip) / d;
  const Eigen::Vector2d t = y.tail<2>() / slip;
  out.impulse << normal, mu * normal * t;
  if (with_stiffness) {
    out.stiffness(0, 0) = 1 / d;
    out.stiffness.block<2, 1>(1, 0) = mu / d * t;
    out.stiffness.block<1, 2>(0, 1) = mu / d * t.transpose();
    out.stiffness.block<2, 2>(1, 1) =
        mu * mu / d * t * t.transpose() + mu * normal / (slip * w_t) * (Eigen::Matrix2d::Identity() - t * t.transpose());
  }
  return out;
}

}  // namespace blem_sim
