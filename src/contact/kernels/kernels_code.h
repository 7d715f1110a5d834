// The kernels. Included once by each file that is compiled for an instruction set.
#include "../tolerances.h"
#include "kernels.h"
#include "lanes.h"

namespace blem_sim::kernels {
namespace {

// Wide vectors are passed inside this file only.
#pragma GCC diagnostic ignored "-Wpsabi"

constexpr unsigned ALL_LANES = (1u << LANES) - 1;

/** Which candidates the lanes hold: behind the last one it is repeated, and masked. */
struct Batch {
  Batch(const Candidate* candidates, std::uint32_t first, std::uint32_t count) {
    for (int i = 0; i < LANES; ++i) {
      const std::uint32_t at = first + i < count ? first + i : count - 1;
      of_a[i] = candidates[at].a;
      of_b[i] = candidates[at].b;
    }
    const std::uint32_t left = count - first;
    valid = left >= LANES ? ALL_LANES : (1u << left) - 1;
  }

  Rows points(const Vec4* from, const std::uint32_t (&index)[LANES]) const {
    const Vec4* at[LANES];
    for (int i = 0; i < LANES; ++i) at[i] = &from[index[i]];
    return gathered(reinterpret_cast<const Vec4* const(&)[LANES]>(at));
  }
  template <typename Record>
  Rows field(const Record* from, const std::uint32_t (&index)[LANES], const Vec4 Record::*member) const {
    const Vec4* at[LANES];
    for (int i = 0; i < LANES; ++i) at[i] = &(from[index[i]].*member);
    return gathered(reinterpret_cast<const Vec4* const(&)[LANES]>(at));
  }
  Rows side(const FaceRecord* from, int k) const {
    const Vec4* at[LANES];
    for (int i = 0; i < LANES; ++i) at[i] = &from[of_b[i]].sides[k];
    return gathered(reinterpret_cast<const Vec4* const(&)[LANES]>(at));
  }
  Rows inward(const EdgeRecord* from, const std::uint32_t (&index)[LANES], int k) const {
    const Vec4* at[LANES];
    for (int i = 0; i < LANES; ++i) at[i] = &from[index[i]].inward[k];
    return gathered(reinterpret_cast<const Vec4* const(&)[LANES]>(at));
  }

  std::uint32_t of_a[LANES], of_b[LANES];
  unsigned valid;
};

/** Calls test(batch) for all; where its bits are set, take(candidate's index, lane). */
template <typename Test, typename Take>
inline void forEachHit(const Candidate* candidates, std::uint32_t count, Test&& test, Take&& take) {
  for (std::uint32_t first = 0; first < count; first += LANES) {
    const Batch batch(candidates, first, count);
    for (unsigned bits = test(batch) & batch.valid; bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      take(first + lane, lane);
    }
  }
}

template <typename Test>
inline std::uint32_t listed(const Candidate* candidates, std::uint32_t count, std::uint32_t* hits, Test&& test) {
  std::uint32_t found = 0;
  forEachHit(candidates, count, test, [&](std::uint32_t i, int) { hits[found++] = i; });
  return found;
}

/** Height over the plane, or inside the side. */
inline Doubles above(const Vectors& p, const Rows& plane) { return dot(p, plane.v) - plane.w; }

inline Doubles insideSides(const Batch& batch, const FaceRecord* faces, const Vectors& p) {
  return minimum(minimum(above(p, batch.side(faces, 0)), above(p, batch.side(faces, 1))), above(p, batch.side(faces, 2)));
}

// ---- motions

typedef double Quad __attribute__((vector_size(32)));

/** A motion by columns, so that a vector turns in three products. */
struct Turn {
  explicit Turn(const Motion& m)
      : x{m.R[0], m.R[3], m.R[6], 0}, y{m.R[1], m.R[4], m.R[7], 0}, z{m.R[2], m.R[5], m.R[8], 0}, shift{m.t[0], m.t[1], m.t[2], 0} {}
  void direction(const Vec4& in, Vec4* out) const { store(in.x * x + in.y * y + in.z * z, in.w, out); }
  void point(const Vec4& in, Vec4* out) const { store(in.x * x + in.y * y + in.z * z + shift, in.w, out); }
  static void store(Quad v, double w, Vec4* out) {
    *reinterpret_cast<Quad*>(out) = v;
    out->w = w;
  }
  Quad x, y, z, shift;
};

void turnPoints(const Vec4* in, std::uint32_t count, const Motion& motion, Vec4* out) {
  const Turn turn(motion);
  for (std::uint32_t i = 0; i < count; ++i) turn.point(in[i], &out[i]);
}

void turnEdges(const EdgeRecord* in, std::uint32_t count, const Motion& motion, EdgeRecord* out) {
  const Turn turn(motion);
  for (std::uint32_t i = 0; i < count; ++i) {
    turn.point(in[i].start, &out[i].start);
    turn.direction(in[i].along, &out[i].along);
    for (int k = 0; k < 2; ++k) turn.direction(in[i].inward[k], &out[i].inward[k]);
  }
}

// ---- leaves

struct FloatVectors {
  Floats x, y, z;
};

inline Floats absolute(Floats a) { return a < 0 ? -a : a; }
inline Floats minimum(Floats a, Floats b) { return a < b ? a : b; }
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
};
inline FloatFace severalFaces(const LeafShapes& leaf, std::uint32_t first) {
  return {severalPlanes(leaf.planes, first),
          {severalPlanes(leaf.sides[0], first), severalPlanes(leaf.sides[1], first), severalPlanes(leaf.sides[2], first)}};
}
inline FloatFace oneFace(const LeafShapes& leaf, std::uint32_t i) {
  return {onePlane(leaf.planes, i), {onePlane(leaf.sides[0], i), onePlane(leaf.sides[1], i), onePlane(leaf.sides[2], i)}};
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
  const Floats most = reach.range - absolute(face.plane.above(p));
  const Floats inside = minimum(minimum(face.sides[0].above(p), face.sides[1].above(p)), face.sides[2].above(p));
  return (most >= 0) & (inside >= -(most / static_cast<float>(FADE_SLOPE) + reach.margin));
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
  turnRows(in.starts, in.edge_count, R, t, out->starts);
  turnRows(in.alongs, in.edge_count, R, none, out->alongs);
  for (int k = 0; k < 2; ++k) turnPlanes(in.inwards[k], in.edge_count, R, t, out->inwards[k]);
  turnRows(in.vertices, in.vertex_count, R, t, out->vertices);
}

// ---- what can have a contact soon: as for leaves, in double

template <typename Test>
inline std::uint32_t copied(const Candidate* in, std::uint32_t count, Candidate* out, Test&& test) {
  std::uint32_t kept = 0;
  forEachHit(in, count, test, [&](std::uint32_t i, int) { out[kept++] = in[i]; });
  return kept;
}

std::uint32_t nearVertexFaces(const Vec4* a, const FaceRecord* b, const Candidate* in, std::uint32_t count, const Reach& reach,
                              Candidate* out) {
  const double range = reach.range + reach.margin, beside = reach.margin + 3 * CLOSED;
  return copied(in, count, out, [&](const Batch& batch) {
    const Vectors p = batch.points(a, batch.of_a).v;
    const Doubles most = range - absolute(above(p, batch.field(b, batch.of_b, &FaceRecord::plane)));
    const unsigned near = bitsOf(most >= 0);
    return near == 0 ? 0 : near & bitsOf(insideSides(batch, b, p) >= -(most / FADE_SLOPE + beside));
  });
}

/** Are both ends of an edge, seen from the start of another, farther than the limit inside a face of that one? */
inline Mask liesInside(const Vectors& first, const Vectors& second, const Vectors& inward, double limit) {
  return minimum(dot(inward, first), dot(inward, second)) > limit;
}

std::uint32_t nearEdgeEdges(const EdgeRecord* a, const EdgeRecord* b, const Candidate* in, std::uint32_t count, const Reach& reach,
                            Candidate* out) {
  const double range = reach.range + reach.margin, limit = deepestInside(range) + reach.margin;
  return copied(in, count, out, [&](const Batch& batch) {
    const Rows start_a = batch.field(a, batch.of_a, &EdgeRecord::start), start_b = batch.field(b, batch.of_b, &EdgeRecord::start);
    const Vectors p = batch.field(a, batch.of_a, &EdgeRecord::along).v, q = batch.field(b, batch.of_b, &EdgeRecord::along).v;
    const Vectors r = start_b.v - start_a.v, back = start_a.v - start_b.v;
    Mask inside{};
    for (int k = 0; k < 2; ++k) {
      inside |= liesInside(r, r + q, batch.inward(a, batch.of_a, k).v, limit);
      inside |= liesInside(back, back + p, batch.inward(b, batch.of_b, k).v, limit);
    }
    const unsigned crosswise = ~bitsOf(inside) & ALL_LANES;
    if (crosswise == 0) return 0u;
    const Doubles pp = start_a.w, qq = start_b.w, pq = dot(p, q), pr = dot(p, r), qr = dot(q, r), denominator = pp * qq - pq * pq;
    const Doubles first = denominator > 0 ? clampedToUnit((pr * qq - pq * qr) / denominator) : Doubles{};
    const Doubles t = clampedToUnit((pq * first - qr) / qq), s = clampedToUnit((pq * t + pr) / pp);
    const Vectors d = r + t * q - s * p;
    return crosswise & ~bitsOf(dot(d, d) > range * range);
  });
}

std::uint32_t nearVertexEdges(const Vec4* a, const EdgeRecord* b, const Candidate* in, std::uint32_t count, const Reach& reach,
                              Candidate* out) {
  const double range = reach.range + reach.margin, limit = 2 * CONE_SLACK * range + reach.margin + CLOSED;
  return copied(in, count, out, [&](const Batch& batch) {
    const Rows start = batch.field(b, batch.of_b, &EdgeRecord::start);
    const Vectors along = batch.field(b, batch.of_b, &EdgeRecord::along).v, r = batch.points(a, batch.of_a).v - start.v;
    const Vectors d = r - clampedToUnit(dot(r, along) / start.w) * along;
    const Mask inside = (dot(batch.inward(b, batch.of_b, 0).v, r) > limit) | (dot(batch.inward(b, batch.of_b, 1).v, r) > limit);
    return ~bitsOf(inside | (dot(d, d) > range * range));
  });
}

std::uint32_t nearVertexVertices(const Vec4* a, const Vec4* b, const Candidate* in, std::uint32_t count, const Reach& reach,
                                 Candidate* out) {
  const double range = reach.range + reach.margin;
  return copied(in, count, out, [&](const Batch& batch) {
    const Vectors d = batch.points(a, batch.of_a).v - batch.points(b, batch.of_b).v;
    return bitsOf(dot(d, d) <= range * range);
  });
}

// ---- what has a contact

/** Offset from the foot on an edge, which may lie beyond its ends, and where that foot is as part of the edge. */
struct EdgeOffset {
  Vectors d;
  Doubles part;
};

inline EdgeOffset offsetFrom(const Rows& start, const Vectors& along, const Vectors& p) {
  const Vectors r = p - start.v;
  const Doubles part = dot(r, along) / start.w;
  return {r - part * along, part};
}

std::uint32_t vertexFaces(const Vec4* a, const FaceRecord* b, const Candidate* candidates, std::uint32_t count, double range,
                          VertexFaceHit* hits) {
  std::uint32_t found = 0;
  double heights[LANES];
  unsigned plain = 0, beside = 0, near_border = 0;
  forEachHit(
      candidates, count,
      [&](const Batch& batch) {
        const Vectors p = batch.points(a, batch.of_a).v;
        const Doubles height = above(p, batch.field(b, batch.of_b, &FaceRecord::plane)), most = range - absolute(height);
        const unsigned near = bitsOf(most >= 0);
        if (near == 0) return 0u;
        const Doubles inside = insideSides(batch, b, p);
        __builtin_memcpy(heights, &height, sizeof heights);
        plain = bitsOf((inside >= 0) & (absolute(height) > TOUCH));
        beside = bitsOf(inside < -2 * CLOSED);
        near_border = bitsOf(inside < NEAR_BORDER);
        return near & bitsOf(inside >= -(most / FADE_SLOPE + 2 * CLOSED));
      },
      [&](std::uint32_t i, int lane) {
        hits[found++] = {i, (plain >> lane & 1) != 0, (beside >> lane & 1) != 0, (near_border >> lane & 1) != 0, heights[lane]};
      });
  return found;
}

/** How far a part of an edge times n2 lies beyond its ends. */
inline Doubles beyondEnds(Doubles part, Doubles n2) { return maximum(maximum(-part, part - n2), Doubles{}); }

std::uint32_t edgeEdges(const EdgeRecord* a, const EdgeRecord* b, const Candidate* candidates, std::uint32_t count, double range,
                        EdgeEdgeHit* hits) {
  const double most = range / FADE_SLOPE;
  std::uint32_t found = 0;
  double part_a[LANES], part_b[LANES], gaps[LANES], normals[3][LANES];
  unsigned plain = 0, near_border = 0;
  forEachHit(
      candidates, count,
      [&](const Batch& batch) {
        const Rows start_a = batch.field(a, batch.of_a, &EdgeRecord::start), start_b = batch.field(b, batch.of_b, &EdgeRecord::start);
        const Rows along_a = batch.field(a, batch.of_a, &EdgeRecord::along), along_b = batch.field(b, batch.of_b, &EdgeRecord::along);
        const Vectors &p = along_a.v, &q = along_b.v, r = start_b.v - start_a.v, n = cross(p, q);
        const Doubles pp = start_a.w, qq = start_b.w, n2 = dot(n, n), rn = dot(r, n);
        const Doubles s = dot(cross(r, q), n), t = dot(cross(r, p), n), over_s = beyondEnds(s, n2), over_t = beyondEnds(t, n2);
        const Doubles most2 = most * most * n2 * n2;
        const unsigned near = bitsOf((rn * rn <= range * range * n2) & (n2 > MIN_EDGE_SINE * MIN_EDGE_SINE * pp * qq) &
                                     (over_s * over_s * pp <= most2) & (over_t * over_t * qq <= most2));
        if (near == 0) return 0u;
        const Doubles norm = squareRoot(n2), gap = absolute(rn) / norm;
        const Vectors normal = (rn > 0 ? all(-1) : all(1)) / norm * n;
        const Mask touch = gap <= TOUCH;
        Mask allowed = dot(batch.inward(b, batch.of_b, 0).v, normal) <= EDGE_CONE_SLACK;
        allowed &= dot(batch.inward(b, batch.of_b, 1).v, normal) <= EDGE_CONE_SLACK;
        allowed &= dot(batch.inward(a, batch.of_a, 0).v, normal) >= -EDGE_CONE_SLACK;
        allowed &= dot(batch.inward(a, batch.of_a, 1).v, normal) >= -EDGE_CONE_SLACK;
        plain = bitsOf((over_s == 0) & (over_t == 0) & ~touch & (along_a.w + along_b.w == 0));
        const Doubles border2 = NEAR_BORDER * NEAR_BORDER * n2 * n2, end_s = minimum(s, n2 - s), end_t = minimum(t, n2 - t);
        near_border = bitsOf((end_s * end_s * pp < border2) | (end_t * end_t * qq < border2));
        const Doubles foot_s = s / n2, foot_t = t / n2;
        __builtin_memcpy(part_a, &foot_s, sizeof part_a);
        __builtin_memcpy(part_b, &foot_t, sizeof part_b);
        __builtin_memcpy(gaps, &gap, sizeof gaps);
        __builtin_memcpy(normals[0], &normal.x, sizeof normals[0]);
        __builtin_memcpy(normals[1], &normal.y, sizeof normals[1]);
        __builtin_memcpy(normals[2], &normal.z, sizeof normals[2]);
        return near & bitsOf(allowed | touch);
      },
      [&](std::uint32_t i, int lane) {
        hits[found++] = {i,
                         (plain >> lane & 1) != 0,
                         (near_border >> lane & 1) != 0,
                         part_a[lane],
                         part_b[lane],
                         gaps[lane],
                         {normals[0][lane], normals[1][lane], normals[2][lane]}};
      });
  return found;
}

std::uint32_t vertexEdges(const Vec4* a, const EdgeRecord* b, const Candidate* candidates, std::uint32_t count, double range,
                          std::uint32_t* hits) {
  return listed(candidates, count, hits, [&](const Batch& batch) {
    const Rows start = batch.field(b, batch.of_b, &EdgeRecord::start);
    const EdgeOffset offset = offsetFrom(start, batch.field(b, batch.of_b, &EdgeRecord::along).v, batch.points(a, batch.of_a).v);
    const Doubles d2 = dot(offset.d, offset.d), over = beyondEnds(offset.part, all(1));
    const unsigned near = bitsOf((d2 <= range * range) & (over * over * start.w <= 4 * CLOSED * CLOSED));
    if (near == 0) return 0u;
    const Doubles limit = 2 * CONE_SLACK * squareRoot(d2) + 2 * TOUCH;
    return near &
           bitsOf((dot(batch.inward(b, batch.of_b, 0).v, offset.d) <= limit) & (dot(batch.inward(b, batch.of_b, 1).v, offset.d) <= limit));
  });
}

std::uint32_t vertexVertices(const Vec4* a, const Vec4* b, const Candidate* candidates, std::uint32_t count, double range,
                             std::uint32_t* hits) {
  return listed(candidates, count, hits, [&](const Batch& batch) {
    const Vectors d = batch.points(a, batch.of_a).v - batch.points(b, batch.of_b).v;
    return bitsOf(dot(d, d) <= range * range);
  });
}

std::uint32_t edgeFaces(const EdgeRecord* a, const FaceRecord* b, const Candidate* candidates, std::uint32_t count, std::uint32_t* hits) {
  return listed(candidates, count, hits, [&](const Batch& batch) {
    const Vectors start = batch.field(a, batch.of_a, &EdgeRecord::start).v, along = batch.field(a, batch.of_a, &EdgeRecord::along).v;
    const Rows plane = batch.field(b, batch.of_b, &FaceRecord::plane);
    const Doubles first = above(start, plane), second = above(start + along, plane);
    const unsigned through = bitsOf((minimum(first, second) < -TOUCH) & (maximum(first, second) > TOUCH));
    if (through == 0) return 0u;
    return through & bitsOf(insideSides(batch, b, start + first / (first - second) * along) >= -2 * CLOSED);
  });
}

}  // namespace
}  // namespace blem_sim::kernels

#define BLEM_SIM_KERNEL_TABLE(name)                                                                                      \
  {                                                                                                                      \
    name, turnPoints, turnEdges, turnLeaf, leafContacts, leafCrossings, nearVertexFaces, nearEdgeEdges, nearVertexEdges, \
        nearVertexVertices, vertexFaces, edgeEdges, vertexEdges, vertexVertices, edgeFaces                               \
  }
