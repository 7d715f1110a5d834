// The walks over a Bvh that are templates: pairs of leaves of two trees, leaves in a box, leaves below a plane.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "blem_sim/geometry/bvh.h"

namespace blem_sim {
namespace bvh_detail {

/** Bound of the rounding of a few sums and products, relative to the largest term. */
constexpr double ROUNDING = 16 * std::numeric_limits<double>::epsilon();

inline Vector3 centre(const Bvh::Node& node) { return 0.5 * (node.lower.cast<double>() + node.upper.cast<double>()); }
inline Vector3 halfExtents(const Bvh::Node& node) { return 0.5 * (node.upper.cast<double>() - node.lower.cast<double>()); }

/** A box given by its centre and its half extents. */
struct CentredBox {
  Vector3 centre, half;
};

/** A's frame seen from B, with |R|, which turns half extents. */
struct FrameChange {
  explicit FrameChange(const Pose& X_BA) : R_BA(X_BA.linear()), abs_R_BA(R_BA.cwiseAbs()), p_BA(X_BA.translation()) {}

  /** Box in B's axes that holds the node's box, widened by what rounding can lose. */
  CentredBox bound(const Bvh::Node& node) const {
    const Vector3 c = centre(node), h = halfExtents(node);
    const Vector3 turned = abs_R_BA * h;
    return {R_BA * c + p_BA, turned + ROUNDING * (turned + abs_R_BA * c.cwiseAbs() + p_BA.cwiseAbs())};
  }

  Matrix3 R_BA, abs_R_BA;
  Vector3 p_BA;
};

/** May the two boxes be within margin? Never false by rounding. */
inline bool mayBeWithin(const CentredBox& a, const Bvh::Node& b, double margin) {
  const Vector3 b_centre = centre(b);
  const Vector3 reach = a.half + halfExtents(b) + ROUNDING * b_centre.cwiseAbs();
  const Vector3 gap = ((a.centre - b_centre).cwiseAbs() - reach).cwiseMax(0.0);
  return gap.squaredNorm() <= margin * margin * (1 + ROUNDING);
}

inline float size(const Bvh::Node& node) { return (node.upper - node.lower).sum(); }

/** Of an inner and any other node, is it a that is opened? Depends on the trees only, so that the order of visits does not move. */
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
void visitLeafPairsIf(const Bvh& a, const Bvh& b, const Pose& X_BA, double margin, Matters&& matters, Visit&& visit) {
  using namespace bvh_detail;
  if (a.empty() || b.empty() || margin < 0) return;
  struct Pair {
    std::uint32_t a, b;
    CentredBox box_a;  // of a, in B's frame: turned once when a is opened, kept while b is
  };
  const FrameChange change(X_BA);
  std::array<Pair, 2 * Bvh::MAX_DEPTH + 1> stack;
  int depth = 0;
  stack[depth++] = {0, 0, change.bound(a.nodes()[0])};
  while (depth > 0) {
    const Pair pair = stack[--depth];
    const Bvh::Node& node_a = a.nodes()[pair.a];
    const Bvh::Node& node_b = b.nodes()[pair.b];
    if (!matters(pair.a, pair.b) || !mayBeWithin(pair.box_a, node_b, margin)) continue;
    if (node_a.isLeaf() && node_b.isLeaf()) {
      visit(pair.a, pair.b);
    } else if (descendsFirst(node_a, node_b)) {
      for (const std::uint32_t child : {node_a.first + 1, node_a.first}) stack[depth++] = {child, pair.b, change.bound(a.nodes()[child])};
    } else {
      for (const std::uint32_t child : {node_b.first + 1, node_b.first}) stack[depth++] = {pair.a, child, pair.box_a};
    }
  }
}

template <typename Visit>
void visitLeafPairs(const Bvh& a, const Bvh& b, const Pose& X_BA, double margin, Visit&& visit) {
  visitLeafPairsIf(
      a, b, X_BA, margin, [](std::uint32_t, std::uint32_t) { return true; }, visit);
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

}  // namespace blem_sim
