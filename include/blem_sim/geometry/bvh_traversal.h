// The walks over a Bvh that are templates: pairs of leaves of two trees, leaves in a box, leaves below a plane.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "blem_sim/geometry/bvh.h"

namespace blem_sim::geometry {
namespace bvh_detail {

/** Bound of the rounding of a few sums and products, relative to the largest term. */
constexpr double ROUNDING = 16 * std::numeric_limits<double>::epsilon();

inline Vector3 centre(const Bvh::Node& node) { return 0.5 * (node.lower.cast<double>() + node.upper.cast<double>()); }
inline Vector3 halfExtents(const Bvh::Node& node) { return 0.5 * (node.upper.cast<double>() - node.lower.cast<double>()); }

/** Four numbers that any instruction set takes at once; the last one means nothing. */
struct FloatBox {
  Eigen::Array4f lower, upper;
};

inline FloatBox boxOf(const Bvh::Node& node) {
  static_assert(sizeof(Bvh::Node) == 8 * sizeof(float));
  FloatBox box;
  std::memcpy(box.lower.data(), reinterpret_cast<const char*>(&node), sizeof box.lower);
  std::memcpy(box.upper.data(), reinterpret_cast<const char*>(&node) + 3 * sizeof(float), sizeof box.upper);
  return box;
}

/** A's frame seen from B. */
class FrameChange {
 public:
  explicit FrameChange(const Pose& X_BA) {
    for (int k = 0; k < 3; ++k) axes_[k] << X_BA.linear().col(k).array(), 0;
    shift_ << X_BA.translation().array(), 0;
  }

  /** Box in B's axes that holds the node's box, widened by as much as rounding can lose. */
  FloatBox bound(const Bvh::Node& node) const {
    const Vector3 c = centre(node), h = halfExtents(node);
    const Eigen::Array4d x = axes_[0] * c.x(), y = axes_[1] * c.y(), z = axes_[2] * c.z(), middle = x + y + z + shift_;
    const Eigen::Array4d half = axes_[0].abs() * h.x() + axes_[1].abs() * h.y() + axes_[2].abs() * h.z();
    const Eigen::Array4d wider = half + FLOAT_ROUNDING * (half + x.abs() + y.abs() + z.abs() + shift_.abs());
    return {(middle - wider).cast<float>(), (middle + wider).cast<float>()};
  }

 private:
  static constexpr double FLOAT_ROUNDING = 2 * std::numeric_limits<float>::epsilon();
  Eigen::Array4d axes_[3], shift_;
};

/** Test whether boxes may be within a margin [m]; never false by rounding. */
class WithinMargin {
 public:
  explicit WithinMargin(double margin)
      : most2_(static_cast<float>(margin * margin * (1 + FLOAT_ROUNDING)) + std::numeric_limits<float>::min()) {}
  bool mayHold(const FloatBox& a, const FloatBox& b) const {
    const Eigen::Array4f gap = (a.lower - b.upper).max(b.lower - a.upper).max(0.0f), gap2 = gap * gap;
    return gap2[0] + gap2[1] + gap2[2] <= most2_;
  }

 private:
  static constexpr double FLOAT_ROUNDING = 16 * std::numeric_limits<float>::epsilon();
  float most2_;
};

inline float size(const Bvh::Node& node) { return (node.upper - node.lower).sum(); }

/** Whether node a is opened, not b; one at least is no leaf. Depends on the trees only, so that the order of visits does not move. */
inline bool descendsFirst(const Bvh::Node& a, const Bvh::Node& b) { return b.isLeaf() || (!a.isLeaf() && size(a) >= size(b)); }

/** Calls visit(leaf) for each leaf, left before right, below nodes for which meets(node) holds. */
template <typename Meets, typename Visit>
void visitLeavesIf(const Bvh& tree, Meets&& meets, Visit&& visit) {
  if (tree.empty()) return;
  std::array<std::uint32_t, Bvh::MAX_DEPTH + 1> stack;
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Bvh::Node& node = tree.nodes()[index];
    if (!meets(node)) continue;
    if (node.isLeaf()) {
      visit(index);
    } else {
      stack[depth++] = node.first + 1;
      stack[depth++] = node.first;
    }
  }
}

}  // namespace bvh_detail

template <typename Matters, typename Visit>
void visitLeafPairsIf(const BvhPair& trees, double margin, Matters&& matters, Visit&& visit) {
  using namespace bvh_detail;
  const Bvh &a = trees.a, &b = trees.b;
  if (a.empty() || b.empty() || margin < 0) return;
  struct Pair {
    std::uint32_t a, b;
    FloatBox box_a;  // box of node a in B's frame: turned once when a is opened, kept while b is
  };
  const FrameChange change(trees.X_BA);
  const WithinMargin near(margin);
  std::array<Pair, 2 * Bvh::MAX_DEPTH + 1> stack;
  int depth = 0;
  const auto push = [&](std::uint32_t node_a, std::uint32_t node_b, const FloatBox& box_a) {
    if (near.mayHold(box_a, boxOf(b.nodes()[node_b])) && matters(node_a, node_b)) stack[depth++] = {node_a, node_b, box_a};
  };
  push(0, 0, change.bound(a.nodes()[0]));
  while (depth > 0) {
    const Pair pair = stack[--depth];
    const Bvh::Node& node_a = a.nodes()[pair.a];
    const Bvh::Node& node_b = b.nodes()[pair.b];
    if (node_a.isLeaf() && node_b.isLeaf()) {
      visit(pair.a, pair.b);
    } else if (descendsFirst(node_a, node_b)) {
      for (const std::uint32_t child : {node_a.first + 1, node_a.first}) push(child, pair.b, change.bound(a.nodes()[child]));
    } else {
      for (const std::uint32_t child : {node_b.first + 1, node_b.first}) push(pair.a, child, pair.box_a);
    }
  }
}

template <typename Visit>
void visitLeafPairs(const Bvh& a, const Bvh& b, const Pose& X_BA, double margin, Visit&& visit) {
  visitLeafPairsIf(
      {a, b, X_BA}, margin, [](std::uint32_t, std::uint32_t) { return true; }, visit);
}

template <typename Visit>
void visitLeaves(const Bvh& tree, const Box& box, Visit&& visit) {
  if (box.isEmpty()) return;
  const auto meets = [&box](const Bvh::Node& node) {
    return (node.lower.cast<double>().array() <= box.max().array()).all() && (node.upper.cast<double>().array() >= box.min().array()).all();
  };
  bvh_detail::visitLeavesIf(tree, meets, visit);
}

template <typename Visit>
void visitLeavesBelowPlane(const Bvh& tree, const Vector3& n, double d, double margin, Visit&& visit) {
  using namespace bvh_detail;
  const Vector3 abs_n = n.cwiseAbs();
  const auto meets = [&](const Bvh::Node& node) {
    const Vector3 c = centre(node), h = halfExtents(node);
    const double lowest = n.dot(c) - abs_n.dot(h) - d;
    return lowest <= margin + ROUNDING * (abs_n.dot(c.cwiseAbs() + h) + std::abs(d) + std::abs(margin));
  };
  visitLeavesIf(tree, meets, visit);
}

}  // namespace blem_sim::geometry
