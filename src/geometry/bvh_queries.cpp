#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "blem_sim/geometry/bvh_traversal.h"
#include "blem_sim/geometry/closest_points.h"

namespace blem_sim::geometry {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

double squaredDistance(const Bvh::Node& node, const Vector3& p) {
  const Vector3 outside = (node.lower.cast<double>() - p).cwiseMax(p - node.upper.cast<double>()).cwiseMax(0.0);
  return outside.squaredNorm();
}

}  // namespace

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

}  // namespace blem_sim::geometry
