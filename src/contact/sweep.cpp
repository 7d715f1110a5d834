#include "blem_sim/contact/sweep.h"

#include <algorithm>

#include "blem_sim/geometry/bvh_traversal.h"
#include "blem_sim/geometry/closest_points.h"

namespace blem_sim::contact {
namespace {

constexpr double RESOLUTION = 0.25;  // part of the distance asked for
constexpr int MOST_LOOKS = 256;      // at poses on the way

Matrix3 turned(const Vector3& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Matrix3::Identity();
}

/** Three corners, their box and the normal of their plane, of any length. */
struct Facet {
  explicit Facet(const geometry::Triangle& triangle)
      : corners(triangle),
        low(triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2])),
        high(triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2])),
        normal((triangle[1] - triangle[0]).cross(triangle[2] - triangle[0])) {}

  geometry::Triangle corners;
  Vector3 low, high, normal;
};

/** Whether all corners are on one side of a facet's plane, farther away than a distance [m]. */
bool isBesidePlane(const Facet& plane, const geometry::Triangle& corners, double distance) {
  const double h0 = plane.normal.dot(corners[0] - plane.corners[0]), h1 = plane.normal.dot(corners[1] - plane.corners[0]),
               h2 = plane.normal.dot(corners[2] - plane.corners[0]);
  const double nearest = std::max(std::min({h0, h1, h2}), -std::max({h0, h1, h2}));
  return nearest > 0 && nearest * nearest > distance * distance * plane.normal.squaredNorm();
}

/** Whether two triangles are certainly farther apart than a distance [m]: by their boxes or by one's plane. Most pairs of leaves that are
 *  near each other by their boxes are, as flanks of threads or teeth: exact distances cost twenty times as much. */
bool areApart(const Facet& a, const Facet& b, double distance) {
  constexpr double ROUNDING = 1e-9;  // of the distance
  const double least = (1 + ROUNDING) * distance;
  const Vector3 gap = (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0);
  return gap.squaredNorm() > least * least || isBesidePlane(a, b.corners, least) || isBesidePlane(b, a.corners, least);
}

/** Whether two meshes are within a distance [m] of each other. */
bool areWithin(double distance, const CollisionGeometry& a, const CollisionGeometry& b, const Pose& X_BA) {
  bool found = false;
  const auto looking = [&found](std::uint32_t, std::uint32_t) { return !found; };
  geometry::visitLeafPairsIf({a.bvh(), b.bvh(), X_BA}, distance, looking, [&](std::uint32_t leaf_a, std::uint32_t leaf_b) {
    const geometry::Bvh::Node &node_a = a.bvh().nodes()[leaf_a], &node_b = b.bvh().nodes()[leaf_b];
    for (std::uint32_t i = node_a.first; i < node_a.first + node_a.count && !found; ++i) {
      geometry::Triangle t = geometry::triangleOf(a.mesh(), a.bvh().order()[i]);
      for (Vector3& corner : t) corner = X_BA * corner;
      const Facet facet(t);
      for (std::uint32_t j = node_b.first; j < node_b.first + node_b.count && !found; ++j) {
        const Facet other(geometry::triangleOf(b.mesh(), b.bvh().order()[j]));
        found = !areApart(facet, other, distance) && geometry::closestTriangleTriangle(t, other.corners).distance <= distance;
      }
    }
  });
  return found;
}

/** Two meshes on their way; the smaller one's points are those that may meet the other. */
class SweptPair {
 public:
  SweptPair(const CollisionGeometry& a, const GeometrySweep& sweep_a, const CollisionGeometry& b, const GeometrySweep& sweep_b) {
    const bool a_smaller = a.bounds().diagonal().squaredNorm() <= b.bounds().diagonal().squaredNorm();
    small_ = a_smaller ? &a : &b;
    large_ = a_smaller ? &b : &a;
    sweep_small_ = a_smaller ? &sweep_a : &sweep_b;
    sweep_large_ = a_smaller ? &sweep_b : &sweep_a;
    radius_ = 0.5 * small_->bounds().diagonal().norm();
  }

  /** [m] Points that meet approached each other by no more than this since, or until, a pose at t. @param span of the way, to either side
   */
  double approach(double t, double span) const {
    const GeometrySweep &s = *sweep_small_, &l = *sweep_large_;
    const Vector3 middle = s.at(t) * small_->bounds().center();
    const Vector3 arm_s = middle - (s.centre + t * s.shift), arm_l = middle - (l.centre + t * l.shift);
    const Vector3 velocity = s.shift + s.turn.cross(arm_s) - l.shift - l.turn.cross(arm_l);
    const double turn_s = s.turn.norm(), reach = arm_s.norm();
    const double change = turn_s * turn_s * reach + l.turn.norm() * (s.shift.norm() + turn_s * reach + l.shift.norm());
    return (velocity.norm() + (s.turn - l.turn).norm() * radius_ + span * change) * span;
  }

  bool mayComeWithin(double distance, double from, double to) {
    const double t = 0.5 * (from + to), most = approach(t, 0.5 * (to - from));
    if (++looks_ > MOST_LOOKS) return true;
    if (!areWithin(distance + most, *small_, *large_, sweep_large_->at(t).inverse() * sweep_small_->at(t))) return false;
    if (most <= RESOLUTION * distance) return true;
    return mayComeWithin(distance, from, t) || mayComeWithin(distance, t, to);
  }

 private:
  const CollisionGeometry *small_, *large_;
  const GeometrySweep *sweep_small_, *sweep_large_;
  double radius_;  // [m] about the middle of the smaller one's box
  int looks_ = 0;
};

}  // namespace

Pose GeometrySweep::at(double t) const {
  const Matrix3 R = turned(t * turn);
  Pose pose = X_WC;
  pose.linear() = R * X_WC.linear();
  pose.translation() = centre + t * shift + R * (X_WC.translation() - centre);
  return pose;
}

Vector3 turnBetween(const Pose& before, const Pose& after) {
  const Eigen::AngleAxisd turn(Matrix3(after.linear() * before.linear().transpose()));
  return turn.angle() * turn.axis();
}

double mostApproach(const CollisionGeometry& a, const GeometrySweep& sweep_a, const CollisionGeometry& b, const GeometrySweep& sweep_b) {
  return SweptPair(a, sweep_a, b, sweep_b).approach(0, 1);
}

bool mayComeWithin(double distance, const CollisionGeometry& a, const GeometrySweep& sweep_a, const CollisionGeometry& b,
                   const GeometrySweep& sweep_b) {
  return SweptPair(a, sweep_a, b, sweep_b).mayComeWithin(distance, 0, 1);
}

}  // namespace blem_sim::contact
