// Features of two leaves against each other, all of one at once, in float. Included by kernels_code.h only.
#pragma once

#include "features/tolerances.h"
#include "kernels/edge_cones.h"
#include "kernels/edge_sides.h"
#include "kernels/face_sides.h"
#include "kernels/leaves/leaf_lanes.h"
#include "kernels/leaves/leaf_turn.h"
#include "kernels/leaves/near_features.h"

namespace blem_sim::contact::kernels {
namespace {

// While features move by no more than the margin, heights and distances change by no more: so the tests are the exact ones, that much
// wider.

inline FloatMask mayTouch(const FloatVectors& p, const FloatFaces& face, const LeafReach& reach) {
  const Floats height = face.plane.above(p), most = reach.range - absolute(height);
  const Floats inside[3] = {face.sides[0].above(p), face.sides[1].above(p), face.sides[2].above(p)};
  return (most >= 0) & isOverOrFades(inside, openSides(face.open >> reach.open_shift, height, reach.margin), most, reach.margin);
}

inline FloatMask mayTouch(const FloatVectors& p, const LeafEdges& edges, std::uint32_t first, const LeafReach& reach) {
  const FloatVectors r = p - severalVectors(edges.starts, first);
  const Floats inside = dot(severalVectors(edges.inwards[0], first), r), also = dot(severalVectors(edges.inwards[1], first), r);
  const FloatMask beside = maximum(inside, also) <= static_cast<float>(2 * CONE_SLACK) * reach.range + reach.margin;
  if (bitsOf(beside) == 0) return beside;
  const FloatVectors direction = severalVectors(edges.directions, first);
  const Floats along = dot(r, direction), fold = row(&edges.folds[first]);
  const FloatVectors d = r - along * direction;
  const AtEdge<Floats> vertex{{inside, also}, squareRoot(dot(d, d)), maximum(-along, along - row(&edges.lengths[first]))};
  return beside & isAtEdge(vertex, absolute(fold), fold < 0, EdgeReach<float>{reach.range, reach.margin, reach.rounding});
}

/** Cones of vertices: of one in all lanes, or of several. */
struct FloatCones {
  FloatVectors axis;
  Floats up, down, per_slack;
};
inline FloatCones oneCone(const LeafCones& cones, std::uint32_t k) {
  return {oneVector(cones.axes, k), allFloats(cones.up[k]), allFloats(cones.down[k]), allFloats(cones.per_slack[k])};
}
inline FloatCones severalCones(const LeafCones& cones, std::uint32_t first) {
  return {severalVectors(cones.axes, first), row(&cones.up[first]), row(&cones.down[first]), row(&cones.per_slack[first])};
}

/** Whether these vertices may be nearest: perhaps no edge of them leads along d. @param d from the vertices, d2 its square
 * @param slack [m] */
inline FloatMask mayBeNearest(const FloatCones& of, const FloatVectors& d, Floats d2, float slack) {
  const Floats along = dot(of.axis, d), most = of.per_slack * slack + absolute(along) * (along > 0 ? of.up : of.down);
  return (most >= 0) & (d2 - along * along <= most * most);
}

/** Whether vertex i of one leaf and several of another may touch: each may be the nearest of its surface, or one may and is round. */
inline FloatMask mayTouch(const LeafShapes& a, std::uint32_t i, const LeafShapes& b, std::uint32_t first, const LeafReach& reach) {
  const FloatVectors d = oneVertex(a, i) - severalVertices(b, first), back = {-d.x, -d.y, -d.z};
  const Floats d2 = dot(d, d);
  const FloatMask near = d2 <= reach.range * reach.range;
  if (bitsOf(near) == 0) return near;
  const float slack = static_cast<float>(CONE_SLACK) * reach.range + reach.margin;
  const LeafCones &one = blockOf(a.cones, i), &several = blockOf(b.cones, first);
  const std::uint32_t k = i % LEAF_BLOCK, j = first % LEAF_BLOCK;
  const FloatMask a_may = mayBeNearest(oneCone(one, k), back, d2, slack), b_may = mayBeNearest(severalCones(several, j), d, d2, slack);
  const FloatMask b_round = maskRow(&several.round[j]);
  return near & ((a_may & b_may) | (b_may & b_round) | (a_may & one.round[k]));
}

/** Whether an end of an edge lies no farther than `limit` [m] inside a face of the other. @param start as the other's start sees it */
inline FloatMask reachesOut(const FloatVectors& start, const FloatVectors& along, const FloatVectors& inward, float limit) {
  return dot(inward, start) + minimum(dot(inward, along), Floats{}) <= limit;
}

inline FloatMask mayTouch(const FloatEdge& a, const FloatEdge& b, const LeafReach& reach) {
  const FloatVectors &p = a.along, &q = b.along, r = b.start - a.start, back = a.start - b.start;
  FloatMask may = reachesOut(r, q, a.inward[0], reach.inside) & reachesOut(r, q, a.inward[1], reach.inside);
  may &= reachesOut(back, p, b.inward[0], reach.inside) & reachesOut(back, p, b.inward[1], reach.inside);
  if (bitsOf(may) == 0) return may;
  const Floats pp = dot(p, p), qq = dot(q, q);
  const FloatVectors n = cross(p, q);
  may &= conesMayAllow(n, coneBound(dot(n, n), pp * qq, reach.turn), a.inward, b.inward);
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
  const Floats first = face.plane.above(start), second = face.plane.above(end), margin = motionAlong(reach, face.plane.normal);
  FloatMask may = (minimum(first, second) <= margin) & (maximum(first, second) >= -margin);
  if (bitsOf(may) == 0) return may;
  for (const FloatPlanes& side : face.sides) may &= maximum(side.above(start), side.above(end)) >= -reach.margin;
  return may;
}

inline void append(std::uint32_t feature, std::uint32_t bits, LeafHit* hits, int* count) {
  hits[*count] = {feature, bits};
  *count += bits != 0;
}

/** Whether edges of the two leaves may have a common perpendicular that points out of the faces of both. */
inline bool mayShareNormal(const EdgeCone& a, const EdgeCone& b, float turn) {
  const float slack = static_cast<float>(2 * 1.001 * EDGE_CONE_SLACK + 1e-4) + 1.1f * turn;
  const float cosine = a.axis[0] * b.axis[0] + a.axis[1] * b.axis[1] + a.axis[2] * b.axis[2];
  // The cosine of the sum of both angles and the slack is no less than this.
  const float least = a.cosine * b.cosine - a.sine * b.sine - slack * (a.sine * b.cosine + a.cosine * b.sine) - 0.5f * slack * slack;
  return (cosine < 0 ? -cosine : cosine) >= least;
}

/** A leaf, and the bits of its vertices near the other one. */
struct LeafAndNear {
  const LeafShapes& leaf;
  std::uint32_t near;
};

/** The near vertices of one leaf at the faces and edges of another. @param side of the vertices */
inline void findAtVertices(const LeafAndNear& a, const LeafShapes& b, const LeafReach& reach, Side side, LeafHits* hits) {
  hits->vertex_faces[side] = hits->vertex_edges[side] = 0;
  forEachBit(a.near, [&](std::uint32_t i) {
    const FloatVectors p = oneVertex(a.leaf, i);
    const std::uint32_t faces = bitsWhere(b.face_count, [&](auto j) { return mayTouch(p, FloatFaces(b.faces, j), reach); });
    append(i, faces, hits->vertex_face[side], &hits->vertex_faces[side]);
    const std::uint32_t edges = edgesWhere(b, [&](const LeafEdges& block, auto j) { return mayTouch(p, block, j, reach); });
    append(i, edges, hits->vertex_edge[side], &hits->vertex_edges[side]);
  });
}

/** Vertices that can each be the nearest of their surface, or one can and is round: it sees the other one near its leaf. */
inline void findVertexVertices(const LeafAndNear& a, const LeafAndNear& b, const LeafReach& reach, LeafHits* hits) {
  const std::uint32_t of_a = b.near == 0 ? 0 : a.leaf.nearest, of_b = a.near == 0 ? 0 : b.leaf.nearest;
  forEachBit(of_a | (of_b == 0 ? 0 : a.near), [&](std::uint32_t i) {
    const std::uint32_t seen = ((of_a >> i & 1) != 0 ? b.near : 0) | ((a.near >> i & 1) != 0 ? of_b : 0);
    const std::uint32_t vertices = bitsWhere(b.leaf.vertex_count, [&](auto j) { return mayTouch(a.leaf, i, b.leaf, j, reach); });
    append(i, vertices & seen, hits->vertex_vertex, &hits->vertex_vertices);
  });
}

inline void findEdgeEdges(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, LeafHits* hits) {
  if (!mayShareNormal(a.edge_cone, b.edge_cone, reach.turn)) return;
  forEachBit(edgesNear(a, b, reach), [&](std::uint32_t i) {
    const FloatEdge edge = oneEdge(a, i);
    const std::uint32_t edges =
        edgesWhere(b, [&](const LeafEdges& block, auto j) { return mayTouch(edge, severalEdges(block, j), reach); });
    append(i, edges, hits->edge_edge, &hits->edge_edges);
  });
}

void leafContacts(const LeafShapes& moving, const LeafShapes& fixed, const LeafReach& reach, LeafHits* hits) {
  const LeafAndNear m{moving, verticesNear(moving, fixed, reach)}, f{fixed, verticesNear(fixed, moving, reach)};
  findAtVertices(m, fixed, reach, Side::MOVING, hits);
  findAtVertices(f, moving, reach, Side::FIXED, hits);
  hits->vertex_vertices = hits->edge_edges = 0;
  findVertexVertices(m, f, reach, hits);
  findEdgeEdges(moving, fixed, reach, hits);
}

inline void findCrossings(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach, Side side, LeafHits* hits) {
  hits->edge_faces[side] = 0;
  forEachBit(edgesAtBox(a, b, reach), [&](std::uint32_t i) {
    const FloatEdge edge = oneEdge(a, i);
    const FloatVectors start = edge.start, end = start + edge.along;
    const std::uint32_t faces = bitsWhere(b.face_count, [&](auto j) { return mayCross(start, end, FloatFaces(b.faces, j), reach); });
    append(i, faces, hits->edge_face[side], &hits->edge_faces[side]);
  });
}

void leafCrossings(const LeafShapes& moving, const LeafShapes& fixed, const LeafReach& reach, LeafHits* hits) {
  findCrossings(moving, fixed, reach, Side::MOVING, hits);
  findCrossings(fixed, moving, reach, Side::FIXED, hits);
}

}  // namespace
}  // namespace blem_sim::contact::kernels
