#include "blem_sim/geometry/ray_cast.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::geometry {
namespace {

/**
 * A ray seen along itself: sheared and scaled so that it runs along +z from the origin. A side that two triangles share is then
 * decided by the same numbers for both, so that no ray slips through between them. [Woop 2013]
 */
class ShearedRay {
 public:
  explicit ShearedRay(const Ray& ray) : origin_(ray.origin) {
    kz_ = longestAxis(ray.direction);
    kx_ = (kz_ + 1) % 3;
    ky_ = (kz_ + 2) % 3;
    shear_ = Vector3(ray.direction[kx_], ray.direction[ky_], 1) / ray.direction[kz_];
  }

  /** Ray parameter of the hit, before or behind the origin; infinity if there is none. */
  double hit(const Vector3& v0, const Vector3& v1, const Vector3& v2) const {
    const Vector3 a = sheared(v0), b = sheared(v1), c = sheared(v2);
    const double u = c.x() * b.y() - c.y() * b.x();
    const double v = a.x() * c.y() - a.y() * c.x();
    const double w = b.x() * a.y() - b.y() * a.x();
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return INFINITY;
    const double det = u + v + w;
    return det == 0 ? INFINITY : (u * a.z() + v * b.z() + w * c.z()) / det;
  }

 private:
  Vector3 sheared(const Vector3& v) const {
    const Vector3 r = v - origin_;
    return {r[kx_] - shear_.x() * r[kz_], r[ky_] - shear_.y() * r[kz_], shear_.z() * r[kz_]};
  }

  Vector3 origin_, shear_;
  int kx_, ky_, kz_;
};

/** Part of a ray inside something convex; empty if it begins after its end. */
struct Chord {
  double begin = INFINITY, end = -INFINITY;

  bool empty() const { return begin > end; }
  void extend(const Chord& other) {
    begin = std::min(begin, other.begin);
    end = std::max(end, other.end);
  }
  double firstWithin(const RayRange& range) const {
    if (empty()) return INFINITY;
    const double first = begin >= range.nearest ? begin : end;
    return first >= range.nearest && first <= range.farthest ? first : INFINITY;
  }
};

/** Chord of an infinite cylinder or a ball, by the ray's way and its start across: without the cylinder's axis, from its middle. */
Chord roundChord(const Vector3& start, const Vector3& way, double radius) {
  const double speed2 = way.squaredNorm();
  if (speed2 == 0) return start.squaredNorm() <= radius * radius ? Chord{-INFINITY, INFINITY} : Chord();
  // The nearest place to the middle first: the discriminant of the quadratic loses digits from afar.
  const double nearest = -start.dot(way) / speed2;
  const double left = radius * radius - (start + nearest * way).squaredNorm();
  if (left < 0) return Chord();
  const double half = std::sqrt(left / speed2);
  return {nearest - half, nearest + half};
}

/** Chord of the cylinder without its round ends. */
Chord tubeChord(const Ray& ray, const std::array<Vector3, 2>& axis, double radius) {
  const Vector3 along = axis[1] - axis[0], unit = along.normalized(), start = ray.origin - axis[0];
  const Chord tube = roundChord(start - start.dot(unit) * unit, ray.direction - ray.direction.dot(unit) * unit, radius);
  const double height = start.dot(unit), climb = ray.direction.dot(unit), length = along.norm();
  if (climb == 0) return height >= 0 && height <= length ? tube : Chord();
  const double bottom = -height / climb, top = (length - height) / climb;
  return {std::max(tube.begin, std::min(bottom, top)), std::min(tube.end, std::max(bottom, top))};
}

/** The elements of a mesh against one ray. */
class ElementHits {
 public:
  ElementHits(const RayMesh& target, const Ray& ray, const RayRange& range)
      : target_(target), ray_(ray), sheared_(ray), range_(range), first_{range.farthest, -1} {}

  const double* farthest() const { return &first_.t; }
  void addLeaf(const Bvh::Node& leaf) {
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) add(static_cast<int>(target_.tree.order()[i]));
  }
  RayHit first() const { return first_.element < 0 ? RayHit() : first_; }

 private:
  void add(int element) {
    const double t = hit(target_.mesh.elements[element]);
    if (!(t >= range_.nearest) || t == INFINITY || t > first_.t) return;
    if (t == first_.t && first_.element >= 0 && first_.element < element) return;
    first_ = {t, element};
  }
  double hit(const Vector3i& e) const {
    const std::vector<Vector3>& v = target_.mesh.vertices;
    if (e[0] != e[1] && e[1] != e[2] && e[2] != e[0]) return sheared_.hit(v[e[0]], v[e[1]], v[e[2]]);
    if (target_.radius <= 0) return INFINITY;
    if (e[0] == e[1] && e[1] == e[2]) return hitBall(ray_, range_, v[e[0]], target_.radius);
    return hitCapsule(ray_, range_, {v[e[0]], e[1] == e[0] ? v[e[2]] : v[e[1]]}, target_.radius);
  }

  const RayMesh& target_;
  const Ray& ray_;
  const ShearedRay sheared_;
  const RayRange range_;
  RayHit first_;
};

}  // namespace

int longestAxis(const Vector3& direction) {
  int axis;
  direction.cwiseAbs().maxCoeff(&axis);
  return axis;
}

double hitBall(const Ray& ray, const RayRange& range, const Vector3& centre, double radius) {
  return roundChord(ray.origin - centre, ray.direction, radius).firstWithin(range);
}

double hitCapsule(const Ray& ray, const RayRange& range, const std::array<Vector3, 2>& axis, double radius) {
  // A line meets something convex in one piece, which is the hull of the pieces in its parts.
  Chord chord;
  if ((axis[1] - axis[0]).squaredNorm() > 0) {
    const Chord tube = tubeChord(ray, axis, radius);
    if (!tube.empty()) chord.extend(tube);
  }
  for (const Vector3& end : axis) {
    const Chord ball = roundChord(ray.origin - end, ray.direction, radius);
    if (!ball.empty()) chord.extend(ball);
  }
  return chord.firstWithin(range);
}

RayHit castRay(const RayMesh& target, const Ray& ray, const RayRange& range) {
  if (!(ray.direction.cwiseAbs().maxCoeff() > 0)) return {};
  ElementHits hits(target, ray, range);
  visitLeavesAlong(RaySlabs(ray, range.nearest, target.radius), target.tree, hits.farthest(),
                   [&](std::uint32_t leaf) { hits.addLeaf(target.tree.nodes()[leaf]); });
  return hits.first();
}

}  // namespace blem_sim::geometry
