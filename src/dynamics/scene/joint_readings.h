// Readings of a scene's joints, from the states of their bodies.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace blem_sim::dynamics {

/** [rad or m] with all full turns; 0 of a fixed joint. */
double jointPosition(const Scene& scene, int joint);
/** [rad/s or m/s] */
double jointVelocity(const Scene& scene, int joint);
/** World axis of a moving joint. */
Vector3 jointAxis(const Scene& scene, int joint);
/** Origin of the joint frame J in the world, J being fixed to the parent, whose state is given by the slot's bits. */
Vector3 jointOrigin(const Scene& scene, int joint, const std::vector<BodyBits>& bits);
/** States of all joints after a step of dt [s]; notes their positions, which tell the full turns. */
void readJoints(double dt, Scene* scene, std::vector<JointState>* states);

/** Inertia [kg m^2] of a body about its centre of mass, world axes. */
Matrix3 inertiaInWorld(const Scene& scene, int body, const Matrix3& R_WB);
/** Inverse inertia along the joint's axis of its two bodies alone, [1/(kg m^2) or 1/kg]: an upper bound of the articulated one. */
double inverseInertia(const Scene& scene, int joint);

}  // namespace blem_sim::dynamics
