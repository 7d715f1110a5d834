// Measures of places on a patch.
#pragma once

#include <algorithm>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "lanes/reduction_lanes.h"

namespace blem_sim::reduction {

/** [1/m] A contact that does not touch yet counts less, by this many unit forces per gap: it cannot carry anything now. */
constexpr double PER_GAP = 5000;
constexpr double DEPTH_TIE = 1e-8;  // [m] depths differ by rounding within it

/** Unit vectors across a unit normal and each other. */
struct PlaneAxes {
  Vector3 u, v;
};

inline PlaneAxes axesAcross(const Vector3& normal) {
  Eigen::Index smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  const Vector3 u = normal.cross(Vector3::Unit(smallest)).normalized();
  return {u, normal.cross(u)};
}

/** Centre, radius and largest depth of some contacts. */
class PatchScale {
 public:
  PatchScale() = default;
  /** @param ready whether they are all finite, with unit normals; else there is no scale */
  PatchScale(const std::vector<contact::Contact>& contacts, bool* ready);

  const Vector3& centre() const { return centre_; }  ///< [m]
  double perRadius() const { return per_radius_; }   ///< [1/m]
  /** A point from the middle, in radii. */
  Vector3 lever(const Vector3& point) const { return (point - centre_) * per_radius_; }
  double depth() const { return depth_; }  ///< [m] of the deepest
  /** Whether no contact is deeper, but for rounding. */
  bool isDeepest(const contact::Contact& contact) const { return contact.depth >= depth_ - DEPTH_TIE; }

 private:
  Vector3 centre_ = Vector3::Zero();
  double per_radius_ = 0;  // [1/m]
  double depth_ = 0;
};

inline WrenchPoint wrenchPoint(const contact::Contact& contact, const PatchScale& scale) {
  const Vector3 lever = scale.lever(contact.point);
  WrenchPoint point;
  for (int axis = 0; axis < 3; ++axis) {
    point.x[axis] = static_cast<float>(lever[axis]);
    point.n[axis] = static_cast<float>(contact.normal_BA[axis]);
  }
  point.handicap = static_cast<float>(std::max(0.0, -contact.depth) * PER_GAP);
  return point;
}

}  // namespace blem_sim::reduction
