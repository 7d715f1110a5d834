// Features of two leaves against each other, all of one at once, in float. Included by kernels_code.h only.
#pragma once

#include "../tolerances.h"
#include "edge_cones.h"
#include "face_sides.h"
#include "lanes.h"

namespace blem_sim::kernels {
namespace {

inline Floats row(const float* from) { return *reinterpret_cast<const Floats*>(from); }

/** Coordinates of several features, or of one in all lanes. */
struct FloatVectors {
  Floats x, y, z;

  static FloatVectors several(const float (&from)[3][LEAF_BLOCK], std::uint32_t first) {
    return {row(&from[0][first]), row(&from[1][first]), row(&from[2][first])};
  }
  static FloatVectors one(const float (&from)[3][LEAF_BLOCK], std::uint32_t i) {
    return {allFloats(from[0][i]), allFloats(from[1][i]), allFloats(from[2][i])};
  }
};

inline Floats dot(const FloatVectors& a, const FloatVectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline FloatVectors operator+(const FloatVectors& a, const FloatVectors& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline FloatVectors operator-(const FloatVectors& a, const FloatVectors& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline FloatVectors operator*(Floats s, const FloatVectors& a) { return {s * a.x, s * a.y, s * a.z}; }

/** Planes, by their normal and offset: several, or one in all lanes. */
struct FloatPlanes {
  FloatVectors normal;
  Floats offset;

  static FloatPlanes several(const float (&from)[4][LEAF_BLOCK], std::uint32_t first) {
    return {{row(&from[0][first]), row(&from[1][first]), row(&from[2][first])}, row(&from[3][first])};
  }
  static FloatPlanes one(const float (&from)[4][LEAF_BLOCK], std::uint32_t i) {
    return {{allFloats(from[0][i]), allFloats(from[1][i]), allFloats(from[2][i])}, allFloats(from[3][i])};
  }
  Floats above(const FloatVectors& p) const { return dot(normal, p) - offset; }
};

struct FloatFaces {
  FloatFaces(const LeafFaces& faces, std::uint32_t first)
      : plane(FloatPlanes::several(faces.planes, first)),
        sides{FloatPlanes::several(faces.sides[0], first), FloatPlanes::several(faces.sides[1], first),
              FloatPlanes::several(faces.sides[2], first)},
        open(*reinterpret_cast<const FloatMask*>(&faces.open[first])) {}
  FloatPlanes plane, sides[3];
  FloatMask open;
};

/** Which block holds feature i of a leaf. */
template <typename Block>
inline const Block& blockOf(const Block (&blocks)[LEAF_BLOCKS], std::uint32_t i) {
  return blocks[i / LEAF_BLOCK];
}
template <typename Block>
inline Block& blockOf(Block (&blocks)[LEAF_BLOCKS], std::uint32_t i) {
  return blocks[i / LEAF_BLOCK];
}

inline FloatVectors oneVertex(const LeafShapes& leaf, std::uint32_t i) {
  return FloatVectors::one(blockOf(leaf.vertices, i).points, i % LEAF_BLOCK);
}
inline FloatVectors severalVertices(const LeafShapes& leaf, std::uint32_t first) {
  return FloatVectors::several(blockOf(leaf.vertices, first).points, first % LEAF_BLOCK);
}

struct FloatEdge {
  FloatVectors start, along;
  FloatPlanes inward[2];
};
inline FloatEdge oneEdge(const LeafShapes& leaf, std::uint32_t index) {
  const LeafEdges& edges = blockOf(leaf.edges, index);
  const std::uint32_t i = index % LEAF_BLOCK;
  return {FloatVectors::one(edges.starts, i),
          FloatVectors::one(edges.alongs, i),
          {FloatPlanes::one(edges.inwards[0], i), FloatPlanes::one(edges.inwards[1], i)}};
}
inline FloatEdge severalEdges(const LeafEdges& edges, std::uint32_t first) {
  return {FloatVectors::several(edges.starts, first),
          FloatVectors::several(edges.alongs, first),
          {FloatPlanes::several(edges.inwards[0], first), FloatPlanes::several(edges.inwards[1], first)}};
}

// Moved by no more than the margin, heights and distances change by no more than it: so the tests are the exact ones, that much wider.

inline FloatMask mayTouch(const FloatVectors& p, const FloatFaces& face, const LeafReach& reach) {
  const Floats height = face.plane.above(p), most = reach.range - absolute(height);
  const Floats inside[3] = {face.sides[0].above(p), face.sides[1].above(p), face.sides[2].above(p)};
  return (most >= 0) & isOverOrFades(inside, openSides(face.open, height, reach.margin), most, reach.margin);
}

/** A vertex has a contact with an edge only where it lies over neither of the edge's faces. */
inline FloatMask mayTouch(const FloatVectors& p, const LeafEdges& edges, std::uint32_t first, const LeafReach& reach) {
  const float limit = static_cast<float>(2 * CONE_SLACK) * reach.range + reach.margin;
  const FloatMask beside =
      (FloatPlanes::several(edges.inwards[0], first).above(p) <= limit) & (FloatPlanes::several(edges.inwards[1], first).above(p) <= limit);
  if (bitsOf(beside) == 0) return beside;
  const FloatVectors along = FloatVectors::several(edges.alongs, first), r = p - FloatVectors::several(edges.starts, first);
  const FloatVectors d = r - clampedToUnit(dot(r, along) * row(&edges.per_length2[first])) * along;
  return beside & ~(dot(d, d) > reach.range * reach.range);
}

/** May no edge of these vertices lead towards what lies that way? @param d from the vertices, d2 its square @param slack [m] */
inline FloatMask mayBeNearest(const FloatVectors& axis, Floats up, Floats down, Floats per_slack, const FloatVectors& d, Floats d2,
                              float slack) {
  const Floats along = dot(axis, d), most = per_slack * slack + absolute(along) * (along > 0 ? up : down);
  return (most >= 0) & (d2 - along * along <= most * most);
}

/** Vertex i of one leaf and several of another: where each is the nearest of its surface, or one is and it is round. */
inline FloatMask mayTouch(const LeafShapes& a, std::uint32_t i, const LeafShapes& b, std::uint32_t first, const LeafReach& reach) {
  const FloatVectors d = oneVertex(a, i) - severalVertices(b, first), back = {-d.x, -d.y, -d.z};
  const Floats d2 = dot(d, d);
  const FloatMask near = d2 <= reach.range * reach.range;
  if (bitsOf(near) == 0) return near;
  const float slack = static_cast<float>(CONE_SLACK) * reach.range + reach.margin;
  const LeafCones &one = blockOf(a.cones, i), &several = blockOf(b.cones, first);
  const std::uint32_t k = i % LEAF_BLOCK, j = first % LEAF_BLOCK;
  const FloatMask a_may = mayBeNearest(FloatVectors::one(one.axes, k), allFloats(one.up[k]), allFloats(one.down[k]),
                                       allFloats(one.per_slack[k]), back, d2, slack);
  const FloatMask b_may = mayBeNearest(FloatVectors::several(several.axes, j), row(&several.up[j]), row(&several.down[j]),
                                       row(&several.per_slack[j]), d, d2, slack);
  const FloatMask b_round = *reinterpret_cast<const FloatMask*>(&several.round[j]);
  return near & ((a_may & b_may) | (b_may & b_round) | (a_may & one.round[k]));
}

/** Are not both ends of an edge too far inside a face of the other? */
inline FloatMask reachesOut(const FloatVectors& start, const FloatVectors& end, const FloatPlanes& inward, float limit) {
  return minimum(inward.above(start), inward.above(end)) <= limit;
}

inline FloatVectors cross(const FloatVectors& a, const FloatVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline FloatMask mayTouch(const FloatEdge& a, const FloatEdge& b, const LeafReach& reach) {
  const FloatVectors &p = a.along, &q = b.along, end_a = a.start + p, end_b = b.start + q, r = b.start - a.start;
  FloatMask may = reachesOut(b.start, end_b, a.inward[0], reach.inside) & reachesOut(b.start, end_b, a.inward[1], reach.inside);
  may &= reachesOut(a.start, end_a, b.inward[0], reach.inside) & reachesOut(a.start, end_a, b.inward[1], reach.inside);
  if (bitsOf(may) == 0) return may;
  const Floats pp = dot(p, p), qq = dot(q, q);
  const FloatVectors n = cross(p, q);
  may &= conesMayAllow(n, coneBound(dot(n, n), pp * qq, reach.turn), a.inward[0].normal, a.inward[1].normal, b.inward[0].normal,
                       b.inward[1].normal);
  if (bitsOf(may) == 0) return may;
  // Closest points of the segments [Ericson 2005, 5.1.9].
  const Floats pq = dot(p, q), pr = dot(p, r), qr = dot(q, r), denominator = pp * qq - pq * pq;
  const Floats first = denominator > 0 ? clampedToUnit((pr * qq - pq * qr) / denominator) : Floats{};
  const Floats t = clampedToUnit((pq * first - qr) / qq), s = clampedToUnit((pq * t + pr) / pp);
  const FloatVectors d = r + t * q - s * p;
  return may & ~(dot(d, d) > reach.range * reach.range);
}

/** Only an edge with ends on both sides of a plane, inside some part of the face, passes through it. */
inline FloatMask mayCross(const FloatVectors& start, const FloatVectors& end, const FloatFaces& face, const LeafReach& reach) {
  const Floats first = face.plane.above(start), second = face.plane.above(end);
  FloatMask may = (minimum(first, second) <= reach.margin) & (maximum(first, second) >= -reach.margin);
  for (const FloatPlanes& side : face.sides) may &= maximum(side.above(start), side.above(end)) >= -reach.margin;
  return may;
}

/** Bits of the features for which test(first of some lanes) holds. */
template <typename Test>
inline std::uint32_t bitsWhere(std::uint32_t count, Test&& test) {
  std::uint32_t bits = 0;
  for (std::uint32_t first = 0; first < count; first += FLOAT_LANES) bits |= bitsOf(test(first)) << first;
  return count < 32 ? bits & ((1u << count) - 1) : bits;
}

/** The same of edges: test(block, first in it). */
template <typename Test>
inline std::uint32_t edgesWhere(const LeafShapes& leaf, Test&& test) {
  return bitsWhere(leaf.edge_count, [&](std::uint32_t i) { return test(blockOf(leaf.edges, i), i % LEAF_BLOCK); });
}

inline void append(std::uint32_t feature, std::uint32_t bits, LeafHit* hits, int* count) {
  hits[*count] = {feature, bits};
  *count += bits != 0;
}

template <typename Visit>
inline void forEachBit(std::uint32_t bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::uint32_t>(__builtin_ctz(bits)));
}

/** Which of some points, or of segments between low and high, are within reach of the leaf's box? */
inline FloatMask isNear(const LeafShapes& leaf, const FloatVectors& low, const FloatVectors& high, float reach) {
  return (low.x <= leaf.upper[0] + reach) & (high.x >= leaf.lower[0] - reach) & (low.y <= leaf.upper[1] + reach) &
         (high.y >= leaf.lower[1] - reach) & (low.z <= leaf.upper[2] + reach) & (high.z >= leaf.lower[2] - reach);
}

inline std::uint32_t verticesNear(const LeafShapes& a, const LeafShapes& b, float reach) {
  return bitsWhere(a.vertex_count, [&](std::uint32_t i) {
    const FloatVectors p = severalVertices(a, i);
    return isNear(b, p, p, reach);
  });
}

inline std::uint32_t edgesNear(const LeafShapes& a, const LeafShapes& b, float reach) {
  return edgesWhere(a, [&](const LeafEdges& edges, std::uint32_t i) {
    const FloatVectors p = FloatVectors::several(edges.starts, i), q = p + FloatVectors::several(edges.alongs, i);
    return isNear(b, {minimum(p.x, q.x), minimum(p.y, q.y), minimum(p.z, q.z)}, {maximum(p.x, q.x), maximum(p.y, q.y), maximum(p.z, q.z)},
                  reach);
  });
}

/** May edges of the two leaves have a common perpendicular that points out of the faces of both? */
inline bool mayShareNormal(const EdgeCone& a, const EdgeCone& b, float turn) {
  constexpr float slack = static_cast<float>(2 * 1.001 * EDGE_CONE_SLACK + 1e-4), right_angle = 1.5707f;
  const float angle = a.spread + b.spread + slack + 1.1f * turn;
  const float cosine = a.axis[0] * b.axis[0] + a.axis[1] * b.axis[1] + a.axis[2] * b.axis[2];
  return angle >= right_angle || (cosine < 0 ? -cosine : cosine) >= __builtin_cosf(angle);
}

/** The vertices of one leaf, by their bits, at the faces and edges of another. */
inline void findAtVertices(const LeafShapes& a, std::uint32_t vertices, const LeafShapes& b, const LeafReach& reach, int order,
                           LeafHits* hits) {
  hits->vertex_faces[order] = hits->vertex_edges[order] = 0;
  forEachBit(vertices, [&](std::uint32_t i) {
    const FloatVectors p = oneVertex(a, i);
    const std::uint32_t faces = bitsWhere(b.face_count, [&](auto j) { return mayTouch(p, FloatFaces(b.faces, j), reach); });
    append(i, faces, hits->vertex_face[order], &hits->vertex_faces[order]);
    const std::uint32_t edges = edgesWhere(b, [&](const LeafEdges& block, auto j) { return mayTouch(p, block, j, reach); });
    append(i, edges, hits->vertex_edge[order], &hits->vertex_edges[order]);
  });
}

void leafContacts(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, LeafHits* hits) {
  const std::uint32_t near_a = verticesNear(a, b, reach.range), near_b = verticesNear(b, a, reach.range);
  findAtVertices(a, near_a, b, reach, 0, hits);
  findAtVertices(b, near_b, a, reach, 1, hits);
  hits->vertex_vertices = hits->edge_edges = 0;
  forEachBit(near_b == 0 ? 0 : near_a, [&](std::uint32_t i) {
    const std::uint32_t vertices = bitsWhere(b.vertex_count, [&](auto j) { return mayTouch(a, i, b, j, reach); });
    append(i, vertices, hits->vertex_vertex, &hits->vertex_vertices);
  });
  if (!mayShareNormal(a.edge_cone, b.edge_cone, reach.turn)) return;
  forEachBit(edgesNear(a, b, reach.range), [&](std::uint32_t i) {
    const FloatEdge edge = oneEdge(a, i);
    const std::uint32_t edges =
        edgesWhere(b, [&](const LeafEdges& block, auto j) { return mayTouch(edge, severalEdges(block, j), reach); });
    append(i, edges, hits->edge_edge, &hits->edge_edges);
  });
}

inline void findCrossings(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, int order, LeafHits* hits) {
  hits->edge_faces[order] = 0;
  forEachBit(edgesNear(a, b, reach.margin), [&](std::uint32_t i) {
    const LeafEdges& edges = blockOf(a.edges, i);
    const FloatVectors start = FloatVectors::one(edges.starts, i % LEAF_BLOCK),
                       end = start + FloatVectors::one(edges.alongs, i % LEAF_BLOCK);
    const std::uint32_t faces = bitsWhere(b.face_count, [&](auto j) { return mayCross(start, end, FloatFaces(b.faces, j), reach); });
    append(i, faces, hits->edge_face[order], &hits->edge_faces[order]);
  });
}

void leafCrossings(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, LeafHits* hits) {
  findCrossings(a, b, reach, 0, hits);
  findCrossings(b, a, reach, 1, hits);
}

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
  /** Normals turn; an offset grows by what the translation is along the normal. */
  void planes(const float (&in)[4][LEAF_BLOCK], float (&out)[4][LEAF_BLOCK]) const {
    directions(in, out);
    for (int i = 0; i < LEAF_BLOCK; i += FLOAT_LANES)
      *reinterpret_cast<Floats*>(&out[3][i]) = row(&in[3][i]) + t[0] * row(&out[0][i]) + t[1] * row(&out[1][i]) + t[2] * row(&out[2][i]);
  }

  float R[9], t[3];

 private:
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
  const float(&axis)[3] = in.edge_cone.axis;
  for (int k = 0; k < 3; ++k) out->edge_cone.axis[k] = turn.R[3 * k] * axis[0] + turn.R[3 * k + 1] * axis[1] + turn.R[3 * k + 2] * axis[2];
  out->edge_cone.spread = in.edge_cone.spread;
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
    for (int k = 0; k < 2; ++k) turn.planes(from.inwards[k], to.inwards[k]);
    turn.points(from.starts, to.starts);
    turn.directions(from.alongs, to.alongs);
    __builtin_memcpy(to.per_length2, from.per_length2, sizeof from.per_length2);
  }
}

}  // namespace
}  // namespace blem_sim::kernels
