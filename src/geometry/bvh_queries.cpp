#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "blem_sim/geometry/bvh_traversal.h"
#include "blem_sim/geometry/closest_points.h"

namespace blem_sim {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/**
 * A ray seen along itself: sheared and scaled so that it runs along +z from the origin. A side that two triangles share is then
 * decided by the same numbers for both, so that no ray slips through between them. [Woop 2013]
 */
class Ray {
 public:
  Ray(const Vector3& origin, const Vector3& direction) : origin_(origin), inverse_(direction.cwiseInverse()) {
    direction.cwiseAbs().maxCoeff(&kz_);
    kx_ = (kz_ + 1) % 3;
    ky_ = (kz_ + 2) % 3;
    shear_ = Vector3(direction[kx_], direction[ky_], 1) / direction[kz_];
  }

  /** Whether the ray may meet the box before t_max; never false by rounding. */
  bool mayMeet(const Bvh::Node& node, double t_max) const {
    double enter = 0, leave = t_max;
    for (int k = 0; k < 3; ++k) {
      const bool forward = !std::signbit(inverse_[k]);
      const double t0 = ((forward ? node.lower[k] : node.upper[k]) - origin_[k]) * inverse_[k];
      const double t1 = ((forward ? node.upper[k] : node.lower[k]) - origin_[k]) * inverse_[k];
      // 0 times infinity, a ray within the box's side, is NaN, which the comparisons let pass.
      if (t0 > enter) enter = t0;
      if (t1 < leave) leave = t1;
    }
    return enter <= leave * (1 + bvh_detail::ROUNDING);
  }

  /** Ray parameter of the hit, infinity if there is none. */
  double hit(const Vector3& v0, const Vector3& v1, const Vector3& v2) const {
    const Vector3 a = sheared(v0), b = sheared(v1), c = sheared(v2);
    const double u = c.x() * b.y() - c.y() * b.x();
    const double v = a.x() * c.y() - a.y() * c.x();
    const double w = b.x() * a.y() - b.y() * a.x();
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return INFINITE;
    const double det = u + v + w;
    if (det == 0) return INFINITE;
    const double t = (u * a.z() + v * b.z() + w * c.z()) / det;
    return t >= 0 ? t : INFINITE;
  }

 private:
  Vector3 sheared(const Vector3& v) const {
    const Vector3 r = v - origin_;
    return {r[kx_] - shear_.x() * r[kz_], r[ky_] - shear_.y() * r[kz_], shear_.z() * r[kz_]};
  }

  Vector3 origin_, inverse_, shear_;
  int kx_, ky_, kz_;
};

double squaredDistance(const Bvh::Node& node, const Vector3& p) {
  const Vector3 outside = (node.lower.cast<double>() - p).cwiseMax(p - node.upper.cast<double>()).cwiseMax(0.0);
  return outside.squaredNorm();
}

}  // namespace

int castRay(const Bvh& tree, const TriangleMesh& mesh, const Vector3& origin, const Vector3& direction, double* t) {
  if (!(direction.cwiseAbs().maxCoeff() > 0)) return -1;
  const Ray ray(origin, direction);
  double best_t = INFINITE;
  int best = -1;
  const auto meets = [&](const Bvh::Node& node) { return ray.mayMeet(node, best_t); };
  bvh_detail::visitLeavesIf(tree, meets, [&](std::uint32_t leaf) {
    const Bvh::Node& node = tree.nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const int element = static_cast<int>(tree.order()[i]);
      if (!mesh.isTriangle(element)) continue;
      const Vector3i& e = mesh.elements[element];
      const double hit = ray.hit(mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]]);
      if (hit < best_t || (hit == best_t && hit < INFINITE && element < best)) {
        best_t = hit;
        best = element;
      }
    }
  });
  if (best >= 0 && t) *t = best_t;
  return best;
}

double distanceToMesh(const Bvh& tree, const TriangleMesh& mesh, const Vector3& p) {
  double best = INFINITE;
  if (tree.empty()) return best;
  std::array<std::pair<std::uint32_t, double>, Bvh::MAX_DEPTH + 1> stack;  // node, squared distance of its box
  int depth = 0;
  stack[depth++] = {0, squaredDistance(tree.nodes()[0], p)};
  while (depth > 0) {
    const auto [index, box_distance2] = stack[--depth];
    if (box_distance2 > best * best) continue;
    const Bvh::Node& node = tree.nodes()[index];
    if (node.isLeaf()) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        best = std::min(best, closestPointTriangle(p, triangleOf(mesh, tree.order()[i])).distance);
      continue;
    }
    // The nearer child comes off the stack first.
    std::pair<std::uint32_t, double> near{node.first, squaredDistance(tree.nodes()[node.first], p)};
    std::pair<std::uint32_t, double> far{node.first + 1, squaredDistance(tree.nodes()[node.first + 1], p)};
    if (far.second < near.second) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
  return best;
}

}  // namespace blem_sim
