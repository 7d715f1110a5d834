// The walk of a ray through a Bvh, nearer boxes first.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "blem_sim/geometry/bvh_traversal.h"

namespace blem_sim::geometry {

/** A ray in any frame; lengths along it are in units of its direction. */
struct Ray {
  Vector3 origin, direction;
};

/** Part of a ray that counts, in units of its direction. */
struct RayRange {
  double nearest = 0, farthest = std::numeric_limits<double>::infinity();
};

/** A ray against boxes. */
class RaySlabs {
 public:
  /** @param wider [m] by which boxes are widened */
  RaySlabs(const Ray& ray, double nearest, double wider)
      : origin_(ray.origin), inverse_(ray.direction.cwiseInverse()), nearest_(nearest), wider_(wider) {}

  /** Place where the ray may enter the box before `farthest`; infinity if it does not. Never so by rounding. */
  double enter(const Bvh::Node& node, double farthest) const {
    double enter = nearest_, leave = farthest;
    for (int k = 0; k < 3; ++k) {
      const double to_lower = (node.lower[k] - wider_ - origin_[k]) * inverse_[k];
      const double to_upper = (node.upper[k] + wider_ - origin_[k]) * inverse_[k];
      const bool forward = !std::signbit(inverse_[k]);
      const double first = forward ? to_lower : to_upper, last = forward ? to_upper : to_lower;
      // 0 times infinity, a ray within the box's side, is NaN, which the comparisons let pass.
      if (first > enter) enter = first;
      if (last < leave) leave = last;
    }
    return enter <= leave * (1 + bvh_detail::ROUNDING) ? enter : std::numeric_limits<double>::infinity();
  }

 private:
  const Vector3 origin_, inverse_;
  const double nearest_, wider_;
};

/** Calls visit(leaf) for every leaf whose box the ray may meet before *farthest, which visit may draw nearer. */
template <typename Visit>
void visitLeavesAlong(const RaySlabs& ray, const Bvh& tree, const double* farthest, Visit&& visit) {
  if (tree.empty()) return;
  struct Entry {
    std::uint32_t node;
    double enter;  // of the ray into its box
  };
  constexpr double NEVER = std::numeric_limits<double>::infinity();
  std::array<Entry, Bvh::MAX_DEPTH + 1> stack;
  int depth = 0;
  const auto push = [&](const Entry& entry) {
    if (entry.enter < NEVER) stack[depth++] = entry;
  };
  const auto entry = [&](std::uint32_t node) { return Entry{node, ray.enter(tree.nodes()[node], *farthest)}; };
  push(entry(0));
  while (depth > 0) {
    const auto [index, enter] = stack[--depth];
    if (enter > *farthest * (1 + bvh_detail::ROUNDING)) continue;
    const Bvh::Node& node = tree.nodes()[index];
    if (node.isLeaf()) {
      visit(index);
      continue;
    }
    Entry near = entry(node.first), far = entry(node.first + 1);
    if (far.enter < near.enter) std::swap(near, far);
    push(far);
    push(near);
  }
}

}  // namespace blem_sim::geometry
