// One contact of the step problem, everything in world axes.
#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim::dynamics {

/** A contact seen from the body it pushes along its normal. */
struct ContactTerm {
  Vector3 point;   ///< about the reference point of that body's tree
  Vector3 normal;  ///< unit
  double friction = 0;
  double compliance = 0;               ///< R [m/s per N s] along the normal, 0 = rigid
  double inverse_mass = 0;             ///< [1/kg] mean over directions
  double stiffest_rho = 0;             ///< least proximal weight [m/s per N s]
  double target = 0;                   ///< [m/s] u_n >= target - R g_n
  Vector3 previous = Vector3::Zero();  ///< [N s] impulse of the first proximal point
  double slip = 0;                     ///< [m/s] |u_t| there
  Vector3 bend = Vector3::Zero();      ///< [m/s] across the normal: by which the bodies' paths bend apart there, over the step
  Vector3 velocity = Vector3::Zero();  ///< [m/s] solved: relative, mean over the step
  Vector3 impulse = Vector3::Zero();   ///< [N s] solved

  Vector3 slipVelocity() const { return velocity - normal.dot(velocity) * normal; }
};

}  // namespace blem_sim::dynamics
