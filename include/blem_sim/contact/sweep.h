// Bounds on the distance of two bare meshes while they move.
#pragma once

#include "blem_sim/contact/collider.h"

namespace blem_sim::contact {

/** A geometry on its way from one state to another: the middle of its turn moves straight and evenly, the turn is even about one axis. */
struct GeometrySweep {
  Pose X_WC = Pose::Identity();      ///< geometry at the start
  Vector3 centre = Vector3::Zero();  ///< [m] world, of its turn at the start: its body's centre of mass
  Vector3 shift = Vector3::Zero();   ///< [m] of the centre, over the whole way
  Vector3 turn = Vector3::Zero();    ///< [rad] rotation vector in world axes, over the whole way

  /** Geometry in the world. @param t part of the way, 0 to 1 */
  Pose at(double t) const;
};

/** [rad] Rotation vector that turns the axes of one pose into those of another, at most pi long. */
Vector3 turnBetween(const Pose& before, const Pose& after);

/** [m] No point of one approaches any point of the other by more on the whole way. Neither is a half-space. */
double mostApproach(const CollisionGeometry& a, const GeometrySweep& sweep_a, const CollisionGeometry& b, const GeometrySweep& sweep_b);

/**
 * Whether bare meshes may be within `distance` [m] > 0 of each other anywhere on their way. Never false if they are; true for some that are
 * within 1.25 times as much only, or where the way is more than some hundred times as long as that. Neither is a half-space.
 */
bool mayComeWithin(double distance, const CollisionGeometry& a, const GeometrySweep& sweep_a, const CollisionGeometry& b,
                   const GeometrySweep& sweep_b);

}  // namespace blem_sim::contact
