// Features of two leaves against each other, all of one at once, in float. Included by kernels_code.h only.
#pragma once

#include "../tolerances.h"
#include "edge_cones.h"
#include "face_sides.h"
#include "lanes.h"

namespace blem_sim::kernels {
namespace {

struct FloatVectors {
  Floats x, y, z;
};

inline Floats absolute(Floats a) { return a < 0 ? -a : a; }
inline Floats clampedToUnit(Floats a) { return minimum(maximum(a, Floats{}), allFloats(1)); }
inline Floats dot(const FloatVectors& a, const FloatVectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline FloatVectors operator+(const FloatVectors& a, const FloatVectors& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline FloatVectors operator-(const FloatVectors& a, const FloatVectors& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline FloatVectors operator*(Floats s, const FloatVectors& a) { return {s * a.x, s * a.y, s * a.z}; }

inline Floats row(const float* from) { return *reinterpret_cast<const Floats*>(from); }

/** Coordinates of several features, or of one in all lanes. */
template <int CAPACITY>
inline FloatVectors several(const float (*from)[CAPACITY], std::uint32_t first) {
  return {row(&from[0][first]), row(&from[1][first]), row(&from[2][first])};
}
template <int CAPACITY>
inline FloatVectors one(const float (*from)[CAPACITY], std::uint32_t i) {
  return {allFloats(from[0][i]), allFloats(from[1][i]), allFloats(from[2][i])};
}

/** Planes, by their normal and offset: several, or one in all lanes. */
struct FloatPlane {
  FloatVectors normal;
  Floats offset;
  Floats above(const FloatVectors& p) const { return dot(normal, p) - offset; }
};
template <int CAPACITY>
inline FloatPlane severalPlanes(const float (*from)[CAPACITY], std::uint32_t first) {
  return {several(from, first), row(&from[3][first])};
}
template <int CAPACITY>
inline FloatPlane onePlane(const float (*from)[CAPACITY], std::uint32_t i) {
  return {one(from, i), allFloats(from[3][i])};
}

struct FloatFace {
  FloatPlane plane, sides[3];
  FloatMask open;
};
inline FloatFace severalFaces(const LeafShapes& leaf, std::uint32_t first) {
  return {severalPlanes(leaf.planes, first),
          {severalPlanes(leaf.sides[0], first), severalPlanes(leaf.sides[1], first), severalPlanes(leaf.sides[2], first)},
          *reinterpret_cast<const FloatMask*>(&leaf.open[first])};
}
struct FloatEdge {
  FloatVectors start, along;
  FloatPlane inward[2];
};
inline FloatEdge severalEdges(const LeafShapes& leaf, std::uint32_t first) {
  return {several(leaf.starts, first),
          several(leaf.alongs, first),
          {severalPlanes(leaf.inwards[0], first), severalPlanes(leaf.inwards[1], first)}};
}
inline FloatEdge oneEdge(const LeafShapes& leaf, std::uint32_t i) {
  return {one(leaf.starts, i), one(leaf.alongs, i), {onePlane(leaf.inwards[0], i), onePlane(leaf.inwards[1], i)}};
}

// Moved by no more than the margin, heights and distances change by no more than it: so the tests are the exact ones, that much wider.

inline FloatMask mayTouch(const FloatVectors& p, const FloatFace& face, const LeafReach& reach) {
  const Floats height = face.plane.above(p), most = reach.range - absolute(height);
  const Floats inside[3] = {face.sides[0].above(p), face.sides[1].above(p), face.sides[2].above(p)};
  return (most >= 0) & isOverOrFades(inside, openSides(face.open, height, reach.margin), most, reach.margin);
}

/** A vertex has a contact with an edge only where it lies over neither of the edge's faces. */
inline FloatMask mayTouch(const FloatVectors& p, const FloatEdge& edge, const LeafReach& reach) {
  const FloatVectors r = p - edge.start;
  const FloatVectors d = r - clampedToUnit(dot(r, edge.along) / dot(edge.along, edge.along)) * edge.along;
  const float limit = static_cast<float>(2 * CONE_SLACK) * reach.range + reach.margin;
  return (edge.inward[0].above(p) <= limit) & (edge.inward[1].above(p) <= limit) & ~(dot(d, d) > reach.range * reach.range);
}

inline FloatMask mayTouch(const FloatVectors& p, const FloatVectors& q, const LeafReach& reach) {
  const FloatVectors d = p - q;
  return dot(d, d) <= reach.range * reach.range;
}

/** Are not both ends of an edge too far inside a face of the other? */
inline FloatMask reachesOut(const FloatVectors& start, const FloatVectors& end, const FloatPlane& inward, float limit) {
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
inline FloatMask mayCross(const FloatEdge& edge, const FloatFace& face, const LeafReach& reach) {
  const FloatVectors end = edge.start + edge.along;
  const Floats first = face.plane.above(edge.start), second = face.plane.above(end);
  FloatMask may = (minimum(first, second) <= reach.margin) & (maximum(first, second) >= -reach.margin);
  for (const FloatPlane& side : face.sides) may &= maximum(side.above(edge.start), side.above(end)) >= -reach.margin;
  return may;
}

/** Bits of the features for which test(first of some lanes) holds. */
template <typename Test>
inline std::uint32_t bitsWhere(std::uint32_t count, Test&& test) {
  std::uint32_t bits = 0;
  for (std::uint32_t first = 0; first < count; first += FLOAT_LANES) bits |= bitsOf(test(first)) << first;
  return count < 32 ? bits & ((1u << count) - 1) : bits;
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
    const FloatVectors p = several(a.vertices, i);
    return isNear(b, p, p, reach);
  });
}

inline std::uint32_t edgesNear(const LeafShapes& a, const LeafShapes& b, float reach) {
  return bitsWhere(a.edge_count, [&](std::uint32_t i) {
    const FloatVectors p = several(a.starts, i), q = p + several(a.alongs, i);
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
    const FloatVectors p = one(a.vertices, i);
    const std::uint32_t faces = bitsWhere(b.face_count, [&](auto j) { return mayTouch(p, severalFaces(b, j), reach); });
    append(i, faces, hits->vertex_face[order], &hits->vertex_faces[order]);
    const std::uint32_t edges = bitsWhere(b.edge_count, [&](auto j) { return mayTouch(p, severalEdges(b, j), reach); });
    append(i, edges, hits->vertex_edge[order], &hits->vertex_edges[order]);
  });
}

void leafContacts(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, LeafHits* hits) {
  const std::uint32_t near_a = verticesNear(a, b, reach.range), near_b = verticesNear(b, a, reach.range);
  findAtVertices(a, near_a, b, reach, 0, hits);
  findAtVertices(b, near_b, a, reach, 1, hits);
  hits->vertex_vertices = hits->edge_edges = 0;
  forEachBit(near_b == 0 ? 0 : near_a, [&](std::uint32_t i) {
    const FloatVectors p = one(a.vertices, i);
    const std::uint32_t vertices = bitsWhere(b.vertex_count, [&](auto j) { return mayTouch(p, several(b.vertices, j), reach); });
    append(i, vertices, hits->vertex_vertex, &hits->vertex_vertices);
  });
  if (!mayShareNormal(a.edge_cone, b.edge_cone, reach.turn)) return;
  forEachBit(edgesNear(a, b, reach.range), [&](std::uint32_t i) {
    const FloatEdge edge = oneEdge(a, i);
    const std::uint32_t edges = bitsWhere(b.edge_count, [&](auto j) { return mayTouch(edge, severalEdges(b, j), reach); });
    append(i, edges, hits->edge_edge, &hits->edge_edges);
  });
}

inline void findCrossings(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, int order, LeafHits* hits) {
  hits->edge_faces[order] = 0;
  forEachBit(edgesNear(a, b, reach.margin), [&](std::uint32_t i) {
    const FloatEdge edge = oneEdge(a, i);
    const std::uint32_t faces = bitsWhere(b.face_count, [&](auto j) { return mayCross(edge, severalFaces(b, j), reach); });
    append(i, faces, hits->edge_face[order], &hits->edge_faces[order]);
  });
}

void leafCrossings(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, LeafHits* hits) {
  findCrossings(a, b, reach, 0, hits);
  findCrossings(b, a, reach, 1, hits);
}

template <int CAPACITY>
inline void turnRows(const float (*in)[CAPACITY], std::uint32_t count, const float* R, const float* t, float (*out)[CAPACITY]) {
  for (std::uint32_t first = 0; first < count; first += FLOAT_LANES) {
    const FloatVectors v = several(in, first);
    for (int k = 0; k < 3; ++k)
      *reinterpret_cast<Floats*>(&out[k][first]) = R[3 * k] * v.x + R[3 * k + 1] * v.y + R[3 * k + 2] * v.z + t[k];
  }
}

/** Normals turn; an offset grows by what the translation is along the normal. */
template <int CAPACITY>
inline void turnPlanes(const float (*in)[CAPACITY], std::uint32_t count, const float* R, const float* t, float (*out)[CAPACITY]) {
  const float none[3] = {0, 0, 0};
  turnRows(in, count, R, none, out);
  for (std::uint32_t first = 0; first < count; first += FLOAT_LANES) {
    const FloatVectors n = several(out, first);
    *reinterpret_cast<Floats*>(&out[3][first]) = row(&in[3][first]) + t[0] * n.x + t[1] * n.y + t[2] * n.z;
  }
}

void turnLeaf(const LeafShapes& in, const Motion& motion, LeafShapes* out) {
  float R[9], t[3];
  const float none[3] = {0, 0, 0};
  for (int i = 0; i < 9; ++i) R[i] = static_cast<float>(motion.R[i]);
  for (int i = 0; i < 3; ++i) t[i] = static_cast<float>(motion.t[i]);
  out->face_count = in.face_count;
  out->edge_count = in.edge_count;
  out->vertex_count = in.vertex_count;
  turnPlanes(in.planes, in.face_count, R, t, out->planes);
  for (int k = 0; k < 3; ++k) turnPlanes(in.sides[k], in.face_count, R, t, out->sides[k]);
  for (int k = 0; k < 3; ++k)
    out->edge_cone.axis[k] = R[3 * k] * in.edge_cone.axis[0] + R[3 * k + 1] * in.edge_cone.axis[1] + R[3 * k + 2] * in.edge_cone.axis[2];
  out->edge_cone.spread = in.edge_cone.spread;
  __builtin_memcpy(out->open, in.open, sizeof in.open);
  turnRows(in.starts, in.edge_count, R, t, out->starts);
  turnRows(in.alongs, in.edge_count, R, none, out->alongs);
  for (int k = 0; k < 2; ++k) turnPlanes(in.inwards[k], in.edge_count, R, t, out->inwards[k]);
  turnRows(in.vertices, in.vertex_count, R, t, out->vertices);
}

}  // namespace
}  // namespace blem_sim::kernels
