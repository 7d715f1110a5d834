// Motion of a body's points while its velocities stay.
#pragma once

#include "build/simulated_world.h"

namespace blem_sim::sim {

/** A body turns about a centre that moves straight. */
struct BodyTwist {
  Vector3 centre = Vector3::Zero(), v = Vector3::Zero(), w = Vector3::Zero();  ///< [m], [m/s] there, [rad/s]; world

  /** Velocity [m/s] of the body's point at p. */
  Vector3 at(const Vector3& p) const { return v + w.cross(p - centre); }

  /** Pose of a frame X of the body `time` [s] later. */
  Pose moved(const Pose& X, double time) const {
    const double angle = time * w.norm();
    const Matrix3 turn = angle > 0 ? Eigen::AngleAxisd(angle, w.normalized()).toRotationMatrix() : Matrix3(Matrix3::Identity());
    Pose Y = X;
    Y.linear() = turn * X.linear();
    Y.translation() = centre + time * v + turn * (X.translation() - centre);
    return Y;
  }
};

/** The twist without its spin about an axis through p: that of a cylinder's surface, which such a spin leaves where it is. */
inline BodyTwist withoutSpin(const BodyTwist& twist, const Vector3& p, const Vector3& axis) {
  return {p, twist.at(p), twist.w - twist.w.dot(axis) * axis};
}

/** Motion of a collider's surface as it is seen from outside: the spin of a cylinder about its axis leaves it where it is.
 *  @param twist of its body */
inline BodyTwist surfaceTwist(const contact::Collider& collider, const Pose& X_WC, const BodyTwist& twist) {
  if (!collider.geometry || !collider.geometry->cylinder()) return twist;
  const Pose X_WK = X_WC * collider.geometry->cylinder()->X_GK;
  return withoutSpin(twist, X_WK.translation(), X_WK.linear().col(2));
}

/** Twist of a body about its centre of mass; none of the world's. @param bodies their states, by slot */
inline BodyTwist twistOf(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, int body) {
  if (body == dynamics::WORLD_BODY) return {};
  return {bodies[body].X_WB * world.world.bodySpec(body).inertial.com, bodies[body].v_WCom, bodies[body].w_WB};
}

}  // namespace blem_sim::sim
