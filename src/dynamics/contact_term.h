// One contact of the step problem: Coulomb's cone with a proximal point, everything in world axes.
#pragma once

#include <cmath>

#include "blem_sim/geometry/types.h"

namespace blem_sim {

/** Impulse of a contact at a relative velocity u, and how it falls with it: its stiffness -d impulse/du is positive semidefinite. */
struct ConeResponse {
  enum class Kind { OPEN, STICK, SLIP } kind = Kind::OPEN;
  Vector3 impulse = Vector3::Zero();
  // The stiffness. STICK: normal_gain along the normal, tangent_gain across. SLIP: normal_gain along the ridge n + mu t, tangent_gain along
  // `side`.
  double normal_gain = 0, tangent_gain = 0;
  Vector3 axis = Vector3::Zero();  ///< the normal, or the ridge
  Vector3 side = Vector3::Zero();

  /** s' stiffness s */
  double curvature(const Vector3& s) const {
    const double along = axis.dot(s);
    if (kind == Kind::STICK) return normal_gain * along * along + tangent_gain * (s.squaredNorm() - along * along);
    if (kind == Kind::OPEN) return 0;
    const double across = side.dot(s);
    return normal_gain * along * along + tangent_gain * across * across;
  }
};

/**
 * Nearest point to normal * y_n + y_t in the cone |g_t| <= mu g_n, measured by w_n (g_n - y_n)^2 + w_t |g_t - y_t|^2.
 * @param y_t perpendicular to the normal
 */
inline ConeResponse projectOnCone(const Vector3& normal, double y_n, const Vector3& y_t, double mu, double w_n, double w_t) {
  ConeResponse out;
  const double slip = y_t.norm();
  if (slip <= mu * y_n) {
    out.kind = ConeResponse::Kind::STICK;
    out.impulse = y_n * normal + y_t;
    out.normal_gain = 1 / w_n;
    out.tangent_gain = 1 / w_t;
    out.axis = normal;
    return out;
  }
  if (w_n * y_n + mu * w_t * slip <= 0) return out;
  const double d = w_n + mu * mu * w_t, push = (w_n * y_n + mu * w_t * slip) / d;
  const Vector3 direction = y_t / slip;
  out.kind = ConeResponse::Kind::SLIP;
  out.axis = normal + mu * direction;
  out.impulse = push * out.axis;
  out.normal_gain = 1 / d;
  out.tangent_gain = mu * push / (slip * w_t);
  out.side = normal.cross(direction);
  return out;
}

/** A contact seen from the body it pushes along its normal. */
struct ContactTerm {
  Vector3 point;   ///< about the reference point of that body's tree
  Vector3 normal;  ///< unit
  double friction = 0;
  double compliance = 0;               ///< R [m/s per N s] along the normal, 0 = rigid
  double inverse_mass = 0;             ///< [1/kg] mean over directions
  double stiffest_rho = 0;             ///< least proximal weight [m/s per N s]
  double rho = 0;                      ///< the present one
  double target = 0;                   ///< [m/s] u_n >= target - R g_n
  Vector3 previous = Vector3::Zero();  ///< [N s] impulse of the proximal point
  double slip = 0;                     ///< [m/s] |u_t| there: De Saxce's term
  Vector3 bend = Vector3::Zero();      ///< [m/s] across the normal: what the bodies' paths bend apart there, over the step
  Vector3 velocity = Vector3::Zero();  ///< [m/s] relative, mean over the step, at the present iterate
  Vector3 step = Vector3::Zero();      ///< its change along the search direction
  Vector3 impulse = Vector3::Zero();   ///< [N s] at the present iterate

  ConeResponse respond(const Vector3& u) const {
    const double w_n = compliance + rho, w_t = rho;
    const Vector3 y = rho * previous - u;
    const double y_n = normal.dot(y);
    return projectOnCone(normal, (y_n + target - friction * slip) / w_n, (y - y_n * normal) / w_t, friction, w_n, w_t);
  }

  Vector3 slipVelocity() const { return velocity - normal.dot(velocity) * normal; }

  /** [N s] by how much the impulse misses Coulomb's law: distance to its own projection after a step against the velocity. */
  double residual() const {
    const Vector3 u_t = slipVelocity();
    const double g_n = normal.dot(impulse);
    const double u_n = normal.dot(velocity) - target + compliance * g_n + friction * u_t.norm();
    const Vector3 g_t = impulse - g_n * normal;
    const double w = inverse_mass + compliance;
    return (projectOnCone(normal, g_n - u_n / w, g_t - u_t / w, friction, 1, 1).impulse - impulse).norm();
  }

  /** Takes the present iterate as the next proximal point. */
  void remember() {
    previous = impulse;
    slip = slipVelocity().norm();
  }
};

}  // namespace blem_sim
