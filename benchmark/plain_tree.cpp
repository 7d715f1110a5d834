#include "plain_tree.h"

#include <algorithm>
#include <numeric>

namespace blem_sim {
namespace {

Box boxOf(const geometry::Triangle& t) { return Box(t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2])); }

geometry::Triangle placed(const Pose& X, const geometry::Triangle& t) { return {X * t[0], X * t[1], X * t[2]}; }

Box placed(const Pose& X, const Eigen::Matrix3d& of_half, const Box& box) {
  const Vector3 half = of_half * (0.5 * box.sizes()), centre = X * box.center();
  return Box(centre - half, centre + half);
}

bool within(const Box& a, const Box& b, double range) {
  const Vector3 gap = (a.min() - b.max()).cwiseMax(b.min() - a.max()).cwiseMax(0.0);
  return gap.squaredNorm() <= range * range;
}

/** Whether a triangle lies on one side of another's plane, farther than `range` [m] from it. */
bool beyondPlane(const geometry::Triangle& t, const geometry::Triangle& plane, double range) {
  const Vector3 normal = (plane[1] - plane[0]).cross(plane[2] - plane[0]);
  const double a = normal.dot(t[0] - plane[0]), b = normal.dot(t[1] - plane[0]), c = normal.dot(t[2] - plane[0]);
  const double gap = std::max(std::min({a, b, c}), -std::max({a, b, c}));
  return gap > 0 && gap * gap > range * range * normal.squaredNorm();
}

}  // namespace

PlainTree::PlainTree(const geometry::TriangleMesh& mesh) : order_(mesh.elements.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) boxes.push_back(boxOf(geometry::triangleOf(mesh, i)));
  nodes_.reserve(2 * order_.size());
  build(0, static_cast<int>(order_.size()), mesh, boxes);
  for (const int i : order_) triangles_.push_back(geometry::triangleOf(mesh, i));
}

void PlainTree::build(int first, int count, const geometry::TriangleMesh& mesh, const std::vector<Box>& boxes) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  for (int i = first; i < first + count; ++i) nodes_[index].box.extend(boxes[order_[i]]);
  nodes_[index].triangle = first;
  if (count == 1) return;
  Eigen::Index axis = 0;
  nodes_[index].box.sizes().maxCoeff(&axis);
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](int a, int b) { return boxes[a].center()[axis] < boxes[b].center()[axis]; });
  build(first, count / 2, mesh, boxes);
  nodes_[index].right = static_cast<int>(nodes_.size());
  build(first + count / 2, count - count / 2, mesh, boxes);
}

void PlainTree::trianglePairs(const PlainTree& a, const PlainTree& b, const Pose& X_BA, double range,
                              std::vector<std::pair<int, int>>* pairs) {
  pairs->clear();
  const Eigen::Matrix3d of_half = X_BA.linear().cwiseAbs();
  std::vector<std::pair<int, int>> stack = {{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const Node &m = a.nodes_[i], &n = b.nodes_[j];
    if (!within(placed(X_BA, of_half, m.box), n.box, range)) continue;
    if (m.right > 0 && (n.right == 0 || m.size() >= n.size())) {
      stack.emplace_back(m.right, j);
      stack.emplace_back(i + 1, j);
    } else if (n.right > 0) {
      stack.emplace_back(i, n.right);
      stack.emplace_back(i, j + 1);
    } else {
      const geometry::Triangle t = placed(X_BA, a.triangles_[m.triangle]), &u = b.triangles_[n.triangle];
      if (within(boxOf(t), n.box, range) && !beyondPlane(t, u, range) && !beyondPlane(u, t, range) &&
          geometry::closestTriangleTriangle(t, u).distance <= range)
        pairs->emplace_back(a.order_[m.triangle], b.order_[n.triangle]);
    }
  }
}

}  // namespace blem_sim
