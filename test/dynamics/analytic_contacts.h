// Contacts of boxes written down directly, for tests of the solver that do not depend on any contact generation.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "blem_sim/dynamics/world.h"

namespace blem_sim::dynamics {

constexpr double CONTACT_MARGIN = 1e-3;  ///< [m] gap up to which contacts exist before touch

inline BodySpec boxBody(const std::string& name, double mass, const Vector3& size, const Vector3& centre) {
  BodySpec spec;
  spec.name = name;
  spec.inertial.mass = mass;
  const Vector3 s = size.cwiseProduct(size);
  spec.inertial.inertia = (mass / 12 * Vector3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y())).asDiagonal();
  spec.X_WB = makePose(centre);
  return spec;
}

/** Properties that all contacts of a pair share. */
struct Surface {
  double friction = 0.5, restitution = 0, impact_friction_factor = 1, impact_friction_speed = 0;
  double stiffness = std::numeric_limits<double>::infinity(), damping = std::numeric_limits<double>::infinity();
};

inline ContactConstraint contactOf(int body_a, int body_b, const Vector3& point, const Vector3& normal_BA, double depth,
                                   const Surface& surface, std::uint64_t id) {
  ContactConstraint c;
  c.body_a = body_a, c.body_b = body_b;
  c.point = point, c.normal_BA = normal_BA, c.depth = depth, c.id = id;
  c.friction = surface.friction, c.restitution = surface.restitution;
  c.impact_friction_factor = surface.impact_friction_factor;
  c.impact_friction_speed = surface.impact_friction_speed;
  c.stiffness = surface.stiffness, c.damping = surface.damping;
  return c;
}

inline Vector3 corner(const Vector3& size, int index) {
  return 0.5 * Vector3(index & 1 ? size.x() : -size.x(), index & 2 ? size.y() : -size.y(), index & 4 ? size.z() : -size.z());
}

/** Corners of a box within the margin of the half space below the plane {normal . x = offset}, which belongs to the static world. */
inline void boxOnPlane(const World& world, int box, const Vector3& size, const Vector3& normal, double offset, const Surface& surface,
                       std::vector<ContactConstraint>* out, double margin = CONTACT_MARGIN) {
  const Pose X_WB = world.bodyState(box).X_WB;
  for (int i = 0; i < 8; ++i) {
    const Vector3 p = X_WB * corner(size, i);
    const double gap = normal.dot(p) - offset;
    if (gap < margin) out->push_back(contactOf(box, WORLD_BODY, p, normal, -gap, surface, 16 * (box + 1) + i));
  }
}

/**
 * Upright boxes of which `upper` stands on `lower`: corners of the overlap rectangle of the upper's bottom and the lower's top, in the
 * lower's frame. Precondition: not yawed against each other by more than a contact's rounding.
 */
inline void boxOnBox(const World& world, int upper, const Vector3& upper_size, int lower, const Vector3& lower_size, const Surface& surface,
                     std::vector<ContactConstraint>* out) {
  const Pose X_WU = world.bodyState(upper).X_WB, X_WL = world.bodyState(lower).X_WB;
  const Pose X_LU = X_WL.inverse() * X_WU;
  const Vector3 normal = X_WL.linear().col(2);
  for (int i = 0; i < 4; ++i) {
    Vector3 p = X_LU * corner(upper_size, i);
    for (int k = 0; k < 2; ++k) p[k] = std::max(-lower_size[k] / 2, std::min(lower_size[k] / 2, p[k]));
    // Height of the upper's bottom plane above this point.
    const Vector3 bottom = X_LU * Vector3(0, 0, -upper_size.z() / 2), axis = X_LU.linear().col(2);
    const double z = bottom.z() - (axis.x() * (p.x() - bottom.x()) + axis.y() * (p.y() - bottom.y())) / axis.z();
    const double gap = z - lower_size.z() / 2;
    if (gap >= CONTACT_MARGIN) continue;
    p.z() = z - gap / 2;
    out->push_back(contactOf(upper, lower, X_WL * p, normal, -gap, surface, 1000000 + 1000 * (upper + 1) + 10 * (lower + 1) + i));
  }
}

}  // namespace blem_sim::dynamics
