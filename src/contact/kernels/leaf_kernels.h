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
inline FloatFace oneFace(const LeafShapes& leaf, std::uint32_t i) {
  return {onePlane(leaf.planes, i),
          {onePlane(leaf.sides[0], i), onePlane(leaf.sides[1], i), onePlane(leaf.sides[2], i)},
          leaf.open[i] - FloatMask{}};
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
  // Closest points of the segments [Ericson 2005, 5.1.9].
  const Floats pp = dot(p, p), qq = dot(q, q), pq = dot(p, q), pr = dot(p, r), qr = dot(q, r), denominator = pp * qq - pq * pq;
  const Floats first = denominator > 0 ? clampedToUnit((pr * qq - pq * qr) / denominator) : Floats{};
  const Floats t = clampedToUnit((pq * first - qr) / qq), s = clampedToUnit((pq * t + pr) / pp);
  const FloatVectors d = r + t * q - s * p;
  may &= ~(dot(d, d) > reach.range * reach.range);
  if (bitsOf(may) == 0) return may;
  const FloatVectors n = cross(p, q);
  const Floats bound = coneBound(dot(n, n), pp * qq, reach.turn);
  return may & conesMayAllow(n, bound, a.inward[0].normal, a.inward[1].normal, b.inward[0].normal, b.inward[1].normal);
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

/** May a segment, or a point, be within reach of the leaf's box? */
inline bool isNear(const LeafShapes& leaf, const float* p, const float* q, float reach) {
  bool near = true;
  for (int k = 0; k < 3; ++k) {
    const float low = p[k] < q[k] ? p[k] : q[k], high = p[k] < q[k] ? q[k] : p[k];
    near &= (low <= leaf.upper[k] + reach) & (high >= leaf.lower[k] - reach);
  }
  return near;
}

inline bool vertexIsNear(const LeafShapes& a, std::uint32_t i, const LeafShapes& b, float reach) {
  const float p[3] = {a.vertices[0][i], a.vertices[1][i], a.vertices[2][i]};
  return isNear(b, p, p, reach);
}

inline bool edgeIsNear(const LeafShapes& a, std::uint32_t i, const LeafShapes& b, float reach) {
  const float p[3] = {a.starts[0][i], a.starts[1][i], a.starts[2][i]};
  const float q[3] = {p[0] + a.alongs[0][i], p[1] + a.alongs[1][i], p[2] + a.alongs[2][i]};
  return isNear(b, p, q, reach);
}

void leafContacts(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, LeafHits* hits) {
  hits->vertex_faces = hits->vertex_edges = hits->vertex_vertices = hits->edge_edges = hits->edge_vertices = hits->face_vertices = 0;
  const auto vertices = [&](auto&& test) { return bitsWhere(b.vertex_count, [&](auto j) { return test(several(b.vertices, j)); }); };
  const auto edges = [&](auto&& test) { return bitsWhere(b.edge_count, [&](auto j) { return test(severalEdges(b, j)); }); };
  const auto faces = [&](auto&& test) { return bitsWhere(b.face_count, [&](auto j) { return test(severalFaces(b, j)); }); };
  for (std::uint32_t i = 0; i < a.vertex_count; ++i) {
    if (!vertexIsNear(a, i, b, reach.range)) continue;
    const FloatVectors p = one(a.vertices, i);
    append(i, faces([&](const FloatFace& face) { return mayTouch(p, face, reach); }), hits->vertex_face, &hits->vertex_faces);
    append(i, edges([&](const FloatEdge& edge) { return mayTouch(p, edge, reach); }), hits->vertex_edge, &hits->vertex_edges);
    append(i, vertices([&](const FloatVectors& q) { return mayTouch(p, q, reach); }), hits->vertex_vertex, &hits->vertex_vertices);
  }
  // Are vertices of b near a at all?
  bool vertices_near = false;
  for (std::uint32_t j = 0; j < b.vertex_count; ++j) vertices_near |= vertexIsNear(b, j, a, reach.range);
  for (std::uint32_t i = 0; i < a.edge_count; ++i) {
    if (!edgeIsNear(a, i, b, reach.range)) continue;
    const FloatEdge edge = oneEdge(a, i);
    append(i, edges([&](const FloatEdge& other) { return mayTouch(edge, other, reach); }), hits->edge_edge, &hits->edge_edges);
    if (!vertices_near) continue;
    append(i, vertices([&](const FloatVectors& q) { return mayTouch(q, edge, reach); }), hits->edge_vertex, &hits->edge_vertices);
  }
  for (std::uint32_t i = 0; vertices_near && i < a.face_count; ++i) {
    const FloatFace face = oneFace(a, i);
    append(i, vertices([&](const FloatVectors& q) { return mayTouch(q, face, reach); }), hits->face_vertex, &hits->face_vertices);
  }
}

void leafCrossings(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, LeafHits* hits) {
  hits->edge_faces = hits->face_edges = 0;
  for (std::uint32_t i = 0; i < a.edge_count; ++i) {
    if (!edgeIsNear(a, i, b, reach.margin)) continue;
    const FloatEdge edge = oneEdge(a, i);
    append(i, bitsWhere(b.face_count, [&](auto j) { return mayCross(edge, severalFaces(b, j), reach); }), hits->edge_face,
           &hits->edge_faces);
  }
  for (std::uint32_t i = 0; i < a.face_count; ++i) {
    const FloatFace face = oneFace(a, i);
    append(i, bitsWhere(b.edge_count, [&](auto j) { return mayCross(severalEdges(b, j), face, reach); }), hits->face_edge,
           &hits->face_edges);
  }
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
  __builtin_memcpy(out->open, in.open, sizeof in.open);
  turnRows(in.starts, in.edge_count, R, t, out->starts);
  turnRows(in.alongs, in.edge_count, R, none, out->alongs);
  for (int k = 0; k < 2; ++k) turnPlanes(in.inwards[k], in.edge_count, R, t, out->inwards[k]);
  turnRows(in.vertices, in.vertex_count, R, t, out->vertices);
}

}  // namespace
}  // namespace blem_sim::kernels
