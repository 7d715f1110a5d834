#include "contacts/motion/meeting_speed.h"

#include <algorithm>
#include <limits>

#include "contacts/motion/body_twist.h"

namespace blem_sim::sim {
namespace {

/** World box of a collider's geometry, grown by `margin` [m]; everything for a half-space. */
Box boxOf(const contact::Collider& collider, const Pose& X_WC, double margin) {
  const Box& box = collider.geometry->bounds();
  if (collider.geometry->isHalfSpace()) return box;
  const Vector3 half = X_WC.linear().cwiseAbs() * (0.5 * (box.max() - box.min())) + Vector3::Constant(margin), centre = X_WC * box.center();
  return Box(centre - half, centre + half);
}

/** Motion of a collider's surface. @param motion poses of the colliders */
BodyTwist twistOfCollider(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                          const std::vector<contact::ColliderMotion>& motion, int collider) {
  const contact::Collider& seen = world.colliders[collider];
  return surfaceTwist(seen, motion[collider].X_WC, twistOf(world, bodies, seen.body));
}

}  // namespace

// Speed at the centre of a collider's box, and what the difference in turning adds at its corners.
double meetingSpeedBound(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                         const std::vector<contact::ColliderMotion>& motion, const contact::ColliderPair& pair) {
  const contact::Collider &a = world.colliders[pair.a], &b = world.colliders[pair.b];
  const bool from_a = !a.geometry->isHalfSpace();
  const contact::Collider& bounded = from_a ? a : b;
  if (bounded.geometry->isHalfSpace()) return std::numeric_limits<double>::infinity();
  const BodyTwist twist_a = twistOfCollider(world, bodies, motion, pair.a), twist_b = twistOfCollider(world, bodies, motion, pair.b);
  const Box box = boxOf(bounded, motion[from_a ? pair.a : pair.b].X_WC, a.radius + b.radius + pair.margin);
  const Vector3 centre = box.center();
  return (twist_a.at(centre) - twist_b.at(centre)).norm() + (twist_a.w - twist_b.w).norm() * 0.5 * box.diagonal().norm();
}

// The speed is a convex function of place, so the corners of the box common to both tell its largest value.
double meetingSpeed(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                    const std::vector<contact::ColliderMotion>& motion, const contact::ColliderPair& pair) {
  const contact::Collider &a = world.colliders[pair.a], &b = world.colliders[pair.b];
  const Pose &X_WA = motion[pair.a].X_WC, &X_WB = motion[pair.b].X_WC;
  const double reach = a.radius + b.radius + pair.margin;
  const Box common = boxOf(a, X_WA, reach).intersection(boxOf(b, X_WB, reach));
  if (common.isEmpty()) return 0;
  Vector3 towards = Vector3::Zero();  // the half-space's way in for A's points
  if (b.geometry->isHalfSpace()) towards = -(X_WB.linear() * b.geometry->planeNormal());
  if (a.geometry->isHalfSpace()) towards = X_WA.linear() * a.geometry->planeNormal();
  const BodyTwist twist_a = twistOfCollider(world, bodies, motion, pair.a), twist_b = twistOfCollider(world, bodies, motion, pair.b);
  double fastest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 p = common.corner(static_cast<Box::CornerType>(corner)), v = twist_a.at(p) - twist_b.at(p);
    fastest = std::max(fastest, towards.isZero(0) ? v.norm() : towards.dot(v));
  }
  return fastest;
}

}  // namespace blem_sim::sim
