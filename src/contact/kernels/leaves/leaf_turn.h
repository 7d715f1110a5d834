// Leaves after a motion. Included by the kernels only.
#pragma once

#include "kernels/leaves/leaf_lanes.h"

namespace blem_sim::contact::kernels {
namespace {

/** A motion of rows of vectors. */
struct LeafTurn {
  explicit LeafTurn(const Motion& motion) {
    for (int i = 0; i < 9; ++i) R[i] = static_cast<float>(motion.R[i]);
    for (int i = 0; i < 3; ++i) t[i] = static_cast<float>(motion.t[i]);
  }

  void points(const float (&in)[3][LEAF_BLOCK], float (&out)[3][LEAF_BLOCK]) const { turn(in, t, out); }
  template <int ROWS>
  void directions(const float (&in)[ROWS][LEAF_BLOCK], float (&out)[ROWS][LEAF_BLOCK]) const {
    const float none[3] = {0, 0, 0};
    turn(in, none, out);
  }
  /** Normals turn; an offset grows by the translation's part along the normal. */
  void planes(const float (&in)[4][LEAF_BLOCK], float (&out)[4][LEAF_BLOCK]) const {
    directions(in, out);
    for (int i = 0; i < LEAF_BLOCK; i += FLOAT_LANES)
      *reinterpret_cast<Floats*>(&out[3][i]) = row(&in[3][i]) + t[0] * row(&out[0][i]) + t[1] * row(&out[1][i]) + t[2] * row(&out[2][i]);
  }

  void direction(const float (&in)[3], float (&out)[3]) const {
    for (int k = 0; k < 3; ++k) out[k] = R[3 * k] * in[0] + R[3 * k + 1] * in[1] + R[3 * k + 2] * in[2];
  }
  /** The box around the turned box. */
  void box(const LeafShapes& in, LeafShapes* out) const {
    const auto size = [](float value) { return value < 0 ? -value : value; };
    for (int k = 0; k < 3; ++k) {
      const float* const r = &R[3 * k];
      out->middle[k] = r[0] * in.middle[0] + r[1] * in.middle[1] + r[2] * in.middle[2] + t[k];
      out->halves[k] = size(r[0]) * in.halves[0] + size(r[1]) * in.halves[1] + size(r[2]) * in.halves[2];
    }
  }
  void region(const LeafRegion& in, LeafRegion* out) const {
    *out = in;
    for (int k = 0; k < 3; ++k) {
      float(&axis)[3] = out->axes[k];
      direction(in.axes[k], axis);
      out->middle[k] += axis[0] * t[0] + axis[1] * t[1] + axis[2] * t[2];
    }
  }

 private:
  float R[9], t[3];

  template <int ROWS>
  void turn(const float (&in)[ROWS][LEAF_BLOCK], const float* shift, float (&out)[ROWS][LEAF_BLOCK]) const {
    for (int i = 0; i < LEAF_BLOCK; i += FLOAT_LANES) {
      const Floats x = row(&in[0][i]), y = row(&in[1][i]), z = row(&in[2][i]);
      for (int k = 0; k < 3; ++k) *reinterpret_cast<Floats*>(&out[k][i]) = R[3 * k] * x + R[3 * k + 1] * y + R[3 * k + 2] * z + shift[k];
    }
  }
};

void turnLeaf(const LeafShapes& in, const Motion& motion, LeafShapes* out) {
  const LeafTurn turn(motion);
  out->face_count = in.face_count;
  out->edge_count = in.edge_count;
  out->vertex_count = in.vertex_count;
  out->edge_cone = in.edge_cone;
  turn.direction(in.edge_cone.axis, out->edge_cone.axis);
  turn.region(in.region, &out->region);
  turn.box(in, out);
  out->nearest = in.nearest;
  turn.planes(in.faces.planes, out->faces.planes);
  for (int k = 0; k < 3; ++k) turn.planes(in.faces.sides[k], out->faces.sides[k]);
  __builtin_memcpy(out->faces.open, in.faces.open, sizeof in.faces.open);
  for (std::uint32_t first = 0; first < in.vertex_count; first += LEAF_BLOCK) {
    turn.points(blockOf(in.vertices, first).points, blockOf(out->vertices, first).points);
    const LeafCones& from = blockOf(in.cones, first);
    LeafCones& to = blockOf(out->cones, first);
    to = from;
    turn.directions(from.axes, to.axes);
  }
  for (std::uint32_t first = 0; first < in.edge_count; first += LEAF_BLOCK) {
    const LeafEdges& from = blockOf(in.edges, first);
    LeafEdges& to = blockOf(out->edges, first);
    for (int k = 0; k < 2; ++k) turn.directions(from.inwards[k], to.inwards[k]);
    turn.points(from.starts, to.starts);
    turn.directions(from.directions, to.directions);
    __builtin_memcpy(to.lengths, from.lengths, sizeof from.lengths);
    __builtin_memcpy(to.folds, from.folds, sizeof from.folds);
  }
}

}  // namespace
}  // namespace blem_sim::contact::kernels
