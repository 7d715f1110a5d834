// Fans of rays through a tree of boxes, and against triangles: each ray by the arithmetic of geometry::castRay, bit by bit. Included by
// kernels_code.h only.
#pragma once

#include "kernels/rays/ray_fan.h"
#include "kernels/simd.h"

namespace blem_sim::contact::kernels {
namespace {

constexpr int FAN_PARTS = FAN / LANES;

/** One number of each ray of a fan, in as many vectors as the instruction set needs. */
struct FanDoubles {
  Doubles part[FAN_PARTS];
};

inline FanDoubles fanDoubles(const double* from) {
  FanDoubles v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

struct FanNode {
  float lower[3], upper[3];
  std::uint32_t first, count;
};
inline FanNode nodeAt(const FanTree& tree, std::uint32_t index) {
  FanNode node;
  __builtin_memcpy(&node, tree.nodes + sizeof node * index, sizeof node);
  return node;
}

/** A fan against boxes; as geometry::RaySlabs. */
class FanSlabs {
 public:
  FanSlabs(const FanRays& fan, double wider) : fan_(fan), wider_(wider) {
    for (int k = 0; k < 3; ++k)
      for (int part = 0; part < FAN_PARTS; ++part) {
        inverse_[k].part[part] = 1 / fanDoubles(fan.directions[k]).part[part];
        forward_[k][part] = reinterpret_cast<Mask>(inverse_[k].part[part]) >= 0;  // the sign bit
      }
  }

  /** Bits of the rays that may meet the box before `farthest`. */
  unsigned meeting(const FanNode& node, const FanDoubles& farthest) const {
    double lower[3], upper[3];
    for (int k = 0; k < 3; ++k) {
      lower[k] = node.lower[k] - wider_ - fan_.origin[k];
      upper[k] = node.upper[k] + wider_ - fan_.origin[k];
    }
    unsigned bits = 0;
    for (int part = 0; part < FAN_PARTS; ++part) {
      Doubles enter = all(fan_.nearest), leave = farthest.part[part];
      for (int k = 0; k < 3; ++k) {
        const Doubles to_lower = lower[k] * inverse_[k].part[part], to_upper = upper[k] * inverse_[k].part[part];
        const Doubles first = forward_[k][part] ? to_lower : to_upper, last = forward_[k][part] ? to_upper : to_lower;
        enter = first > enter ? first : enter;
        leave = last < leave ? last : leave;
      }
      bits |= bitsOf(enter <= leave * (1 + FAN_ROUNDING)) << (part * LANES);
    }
    return bits;
  }

 private:
  const FanRays& fan_;
  const double wider_;
  FanDoubles inverse_[3];
  Mask forward_[3][FAN_PARTS];
};

/** Whether the first ray comes to the middle of the left box before that of the right one. */
inline bool leftFirst(const FanRays& fan, const FanNode& left, const FanNode& right) {
  double ahead = 0;
  for (int k = 0; k < 3; ++k) ahead += fan.directions[k][0] * (right.lower[k] + right.upper[k] - left.lower[k] - left.upper[k]);
  return ahead >= 0;
}

/** Calls visit(index, leaf, lanes) for the leaves that some rays may meet before *farthest, which visit may draw nearer; nearer ones first.
 */
template <typename Visit>
inline void walkFan(const FanTree& tree, const FanRays& fan, const FanDoubles* farthest, Visit&& visit) {
  const FanSlabs slabs(fan, tree.wider);
  std::uint32_t stack[DEEPEST_TREE + 1];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const FanNode node = nodeAt(tree, index);
    const unsigned lanes = slabs.meeting(node, *farthest);
    if (lanes == 0) continue;
    if (node.count != 0) {
      visit(index, node, lanes);
      continue;
    }
    const std::uint32_t right_first = !leftFirst(fan, nodeAt(tree, node.first), nodeAt(tree, node.first + 1));
    stack[depth++] = node.first + 1 - right_first;
    stack[depth++] = node.first + right_first;
  }
}

void fanLeaves(const FanTree& tree, const FanRays& fan, double* farthest, const FanVisitor& visitor) {
  FanDoubles ends = fanDoubles(farthest);
  walkFan(tree, fan, &ends, [&](std::uint32_t index, const FanNode&, unsigned lanes) {
    visitor.visit(visitor.self, index, lanes);
    ends = fanDoubles(farthest);
  });
}

/** Vertices seen from the origin of rays, along the axes of their shear: of one triangle, or one triangle per lane. */
template <typename Number>
using Corner = VectorsOf<Number>;

/** Rays that pass through the triangle, before or behind their origin; as ShearedRay in geometry. @param t where [Woop 2013] */
template <typename Number>
inline Mask passThrough(const Vectors& shear, const Corner<Number> (&corners)[3], Doubles* t) {
  Doubles x[3], y[3];
  for (int i = 0; i < 3; ++i) {
    x[i] = corners[i].x - shear.x * corners[i].z;
    y[i] = corners[i].y - shear.y * corners[i].z;
  }
  const Doubles u = x[2] * y[1] - y[2] * x[1], v = x[0] * y[2] - y[0] * x[2], w = x[1] * y[0] - y[1] * x[0];
  const Mask passes = ~(((u < 0) | (v < 0) | (w < 0)) & ((u > 0) | (v > 0) | (w > 0)));
  if (bitsOf(passes) == 0) return passes;
  const Doubles det = u + v + w;
  *t = (u * (shear.z * corners[0].z) + v * (shear.z * corners[1].z) + w * (shear.z * corners[2].z)) / det;
  return passes & (det != 0);
}

/** A fan seen along its rays; as ShearedRay in geometry. */
class ShearedFan {
 public:
  ShearedFan(const FanRays& fan, int axis) : kx_((axis + 1) % 3), ky_((axis + 2) % 3), kz_(axis) {
    for (int k = 0; k < 3; ++k) origin_[k] = fan.origin[k];
    for (int part = 0; part < FAN_PARTS; ++part) {
      const auto directions = [&](int k) { return fanDoubles(fan.directions[k]).part[part]; };
      shear_[part] = {directions(kx_) / directions(kz_), directions(ky_) / directions(kz_), 1 / directions(kz_)};
    }
  }

  Corner<double> corner(const double* v) const { return {v[kx_] - origin_[kx_], v[ky_] - origin_[ky_], v[kz_] - origin_[kz_]}; }

  /** Rays of a part that pass through the triangle, before or behind the origin. @param t where */
  Mask through(int part, const Corner<double> (&corners)[3], Doubles* t) const { return passThrough(shear_[part], corners, t); }

 private:
  const int kx_, ky_, kz_;
  double origin_[3];
  Vectors shear_[FAN_PARTS];
};

/** Bits as a mask. */
inline Mask maskOf(unsigned bits) {
  Mask mask;
  for (int i = 0; i < LANES; ++i) mask[i] = -static_cast<std::int64_t>(bits >> i & 1);
  return mask;
}

/** First hits so far of a fan's rays. */
struct FirstOfFan {
  FanDoubles t;
  Mask element[FAN_PARTS];

  void add(const ShearedFan& sheared, const Corner<double> (&corners)[3], std::int64_t number, double nearest, unsigned lanes) {
    for (int part = 0; part < FAN_PARTS; ++part) {
      Doubles there = {};
      Mask takes = sheared.through(part, corners, &there);
      if (bitsOf(takes) == 0) continue;
      Doubles& first = t.part[part];
      takes &= maskOf(lanes >> (part * LANES)) & (there >= nearest) & (there < __builtin_inf()) & (there <= first);
      takes &= ~((there == first) & (element[part] >= 0) & (element[part] < number));
      first = takes ? there : first;
      element[part] = takes ? number - Mask{} : element[part];
    }
  }
};

bool fanTriangles(const FanMesh& mesh, const FanRays& fan, FanHits* hits) {
  const ShearedFan sheared(fan, mesh.axis);
  FirstOfFan first;
  first.t = fanDoubles(hits->t);
  __builtin_memcpy(first.element, hits->element, sizeof hits->element);
  bool others = false;
  walkFan(mesh.tree, fan, &first.t, [&](std::uint32_t, const FanNode& leaf, unsigned lanes) {
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      const std::int64_t number = mesh.order[i];
      const int* e = mesh.elements + 3 * number;
      if (e[0] == e[1] || e[1] == e[2] || e[2] == e[0]) {
        others = true;
        continue;
      }
      const auto corner = [&](int k) { return sheared.corner(mesh.vertices + 3 * std::int64_t{e[k]}); };
      first.add(sheared, {corner(0), corner(1), corner(2)}, number, fan.nearest, lanes);
    }
  });
  __builtin_memcpy(hits->t, &first.t, sizeof first.t);
  __builtin_memcpy(hits->element, first.element, sizeof hits->element);
  return others;
}

}  // namespace
}  // namespace blem_sim::contact::kernels
