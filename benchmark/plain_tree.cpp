#include "plain_tree.h"

#include <algorithm>
#include <numeric>

#include "blem_sim/geometry/closest_points.h"

namespace blem_sim {
namespace {

constexpr int LEAF = 4;

Triangle corners(const TriangleMesh& mesh, int element) {
  const Vector3i& e = mesh.elements[element];
  return {mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]]};
}

Box boxOf(const Triangle& t) {
  Box box;
  for (const Vector3& p : t) box.extend(p);
  return box;
}

Box turned(const Box& box, const Pose& X) {
  const Vector3 half = X.linear().cwiseAbs() * (0.5 * box.sizes()), centre = X * box.center();
  return Box(centre - half, centre + half);
}

bool within(const Box& a, const Box& b, double range) { return a.squaredExteriorDistance(b) <= range * range; }

}  // namespace

PlainTree::PlainTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.elements.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vector3> middles;
  for (int i : order_) middles.push_back(boxOf(corners(mesh, i)).center());
  build(0, static_cast<int>(order_.size()), &middles);
}

int PlainTree::build(int first, int count, std::vector<Vector3>* middles) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Box box;
  for (int i = first; i < first + count; ++i) box.extend(boxOf(corners(mesh_, order_[i])));
  nodes_[index].box = box;
  nodes_[index].first = first;
  nodes_[index].count = count;
  if (count <= LEAF) return index;
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto begin = order_.begin() + first, middle = begin + count / 2;
  std::nth_element(begin, middle, begin + count, [&](int a, int b) { return (*middles)[a][axis] < (*middles)[b][axis]; });
  const int left = build(first, count / 2, middles), right = build(first + count / 2, count - count / 2, middles);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

void PlainTree::trianglePairs(const PlainTree& a, const PlainTree& b, const Pose& X_BA, double range,
                              std::vector<std::pair<int, int>>* pairs) {
  pairs->clear();
  std::vector<std::pair<int, int>> stack = {{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const Node &m = a.nodes_[i], &n = b.nodes_[j];
    if (!within(turned(m.box, X_BA), n.box, range)) continue;
    const bool open_m = m.left >= 0 && (n.left < 0 || m.box.sizes().sum() >= n.box.sizes().sum());
    if (open_m) {
      stack.insert(stack.end(), {{m.right, j}, {m.left, j}});
    } else if (n.left >= 0) {
      stack.insert(stack.end(), {{i, n.right}, {i, n.left}});
    } else {
      for (int k = m.first; k < m.first + m.count; ++k) {
        Triangle t = corners(a.mesh_, a.order_[k]);
        for (Vector3& p : t) p = X_BA * p;
        const Box box = boxOf(t);
        for (int l = n.first; l < n.first + n.count; ++l) {
          const Triangle u = corners(b.mesh_, b.order_[l]);
          if (within(box, boxOf(u), range) && closestTriangleTriangle(t, u).distance <= range)
            pairs->emplace_back(a.order_[k], b.order_[l]);
        }
      }
    }
  }
}

}  // namespace blem_sim
