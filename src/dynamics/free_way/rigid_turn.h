// The turn of a rigid body that nothing acts on.
#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim::dynamics {

struct RigidTurn {
  Matrix3 turn;  ///< from the start to the end
  Vector3 spin;  ///< [rad/s] at the end
};

/**
 * Angular momentum is kept exactly; energy swings by 1e-5 of itself at most and does not drift: turns about principal axes, one after the
 * other, are symplectic [McLachlan 1993]. At most 256 of them; a body with three equal moments of inertia needs one.
 * @param inertia [kg m^2] about the centre of mass; momentum [kg m^2/s]: angular, about it; world axes
 */
RigidTurn turnFreely(const Matrix3& inertia, const Vector3& momentum, double dt);

}  // namespace blem_sim::dynamics
