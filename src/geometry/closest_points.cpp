// Every answer is the least of a set of pairs of points that lie in the sets (the ends, the sides, the insides), each found by a formula
// that is only used where it is well conditioned. So a degenerate or parallel case never yields more than rounding above the true distance.
#include "blem_sim/geometry/closest_points.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::geometry {
namespace {

/** Coordinates of size 1 differ by rounding below this. */
constexpr double RELATIVE_ROUNDING = 16 * std::numeric_limits<double>::epsilon();
/** A triangle lower than this part of its longest side is its sides: its normal would be rounding, and its inside is as near as they. */
constexpr double FLAT_HEIGHT = 1e-10;

/** A pair of points, one of each set, with the square of its distance. */
struct ClosestPair {
  double squared_distance = std::numeric_limits<double>::infinity();
  Vector3 point_a = ClosestPoints().point_a, point_b = ClosestPoints().point_b;

  void improve(const Vector3& a, const Vector3& b) {
    const double squared = (a - b).squaredNorm();
    if (!(squared < squared_distance)) return;
    squared_distance = squared;
    point_a = a;
    point_b = b;
  }
  ClosestPoints result() const { return {std::sqrt(squared_distance), point_a, point_b}; }
};

Vector3 closestOnSegment(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 ab = b - a;
  const double along = (p - a).dot(ab), length2 = ab.squaredNorm();
  if (!(along > 0)) return a;
  if (along >= length2) return b;
  return a + along / length2 * ab;
}

/** A triangle with its normal (not unit) and, for each side, the direction in the plane that leads into the triangle. */
struct Face {
  explicit Face(const Triangle& t) : corners(t) {
    const Vector3 ab = t[1] - t[0], bc = t[2] - t[1], ca = t[0] - t[2];
    // The two shorter sides give the better normal of a needle.
    const double ab2 = ab.squaredNorm(), bc2 = bc.squaredNorm(), ca2 = ca.squaredNorm();
    normal = ab2 >= bc2 && ab2 >= ca2 ? bc.cross(ca) : bc2 >= ca2 ? ca.cross(ab) : ab.cross(bc);
    normal2 = normal.squaredNorm();
    const double longest2 = std::max({ab2, bc2, ca2});
    flat = !(normal2 > FLAT_HEIGHT * FLAT_HEIGHT * longest2 * longest2);
    if (flat) return;
    inward = {normal.cross(ab), normal.cross(bc), normal.cross(ca)};
  }

  /** n.(p - corner): the height of p, times |normal|. */
  double height(const Vector3& p) const { return normal.dot(p - corners[0]); }

  /** Whether p projects into the triangle; always false for a triangle without area. */
  bool holdsProjectionOf(const Vector3& p) const {
    return !flat && inward[0].dot(p - corners[0]) >= 0 && inward[1].dot(p - corners[1]) >= 0 && inward[2].dot(p - corners[2]) >= 0;
  }

  Vector3 projection(const Vector3& p) const { return p - height(p) / normal2 * normal; }

  const Triangle& corners;
  Vector3 normal;
  double normal2;
  bool flat;  ///< collinear to rounding: its sides are all there is
  std::array<Vector3, 3> inward;
};

double largestCoordinate(const Triangle& t) {
  return std::max({t[0].cwiseAbs().maxCoeff(), t[1].cwiseAbs().maxCoeff(), t[2].cwiseAbs().maxCoeff()});
}

/** A segment. */
struct Segment {
  Segment(const Vector3& a, const Vector3& b) : from(a), to(b), along(b - a), length2(along.squaredNorm()) {}
  Vector3 from, to, along;
  double length2;
};

/** Well away from parallel: the lines' closest points, one clamped to its side, then the other. [Ericson 2005, 5.1.9] */
void improveByCrosswiseSides(const Segment& a, const Segment& b, double along_ab, ClosestPair* best) {
  const Vector3 r = a.from - b.from;
  const double along_a = a.along.dot(r), along_b = b.along.dot(r);
  const auto clamped = [](double x) { return std::min(std::max(x, 0.0), 1.0); };
  double s = clamped((along_ab * along_b - along_a * b.length2) / (a.length2 * b.length2 - along_ab * along_ab));
  double t = (along_ab * s + along_b) / b.length2;
  if (t < 0) {
    t = 0;
    s = clamped(-along_a / a.length2);
  } else if (t > 1) {
    t = 1;
    s = clamped((along_ab - along_a) / a.length2);
  }
  best->improve(a.from + s * a.along, b.from + t * b.along);
}

/** Any pair, points and parallels too: the ends against the sides, and the lines' closest points if those lie inside. */
void improveByAlignedSides(const Segment& a, const Segment& b, ClosestPair* best) {
  best->improve(a.from, closestOnSegment(a.from, b.from, b.to));
  best->improve(a.to, closestOnSegment(a.to, b.from, b.to));
  best->improve(closestOnSegment(b.from, a.from, a.to), b.from);
  best->improve(closestOnSegment(b.to, a.from, a.to), b.to);
  // The cross product keeps its accuracy for a small angle where a.a b.b - (a.b)^2 loses it.
  const Vector3 r = b.from - a.from, n = a.along.cross(b.along);
  const double n2 = n.squaredNorm();
  if (!(n2 > 0)) return;
  const double s = r.cross(b.along).dot(n) / n2, t = r.cross(a.along).dot(n) / n2;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best->improve(a.from + s * a.along, b.from + t * b.along);
}

void improveBySides(const Segment& a, const Segment& b, ClosestPair* best) {
  constexpr double MIN_SQUARED_SINE = 1e-3;
  const double along_ab = a.along.dot(b.along), product = a.length2 * b.length2;
  if (product - along_ab * along_ab > MIN_SQUARED_SINE * product) {
    improveByCrosswiseSides(a, b, along_ab, best);
  } else {
    improveByAlignedSides(a, b, best);
  }
}

/** Finds the point where an edge of `edges` goes through the face, if one does. @param heights of the corners over the face */
bool crossingPoint(const Triangle& edges, const std::array<double, 3>& heights, const Face& face, Vector3* crossing) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if ((heights[i] > 0) == (heights[j] > 0)) continue;
    const Vector3 point = edges[i] + heights[i] / (heights[i] - heights[j]) * (edges[j] - edges[i]);
    if (!face.holdsProjectionOf(point)) continue;
    *crossing = point;
    return true;
  }
  return false;
}

std::array<double, 3> heightsOver(const Face& face, const Triangle& t) { return {face.height(t[0]), face.height(t[1]), face.height(t[2])}; }

bool straddles(const std::array<double, 3>& heights) {
  return *std::min_element(heights.begin(), heights.end()) <= 0 && *std::max_element(heights.begin(), heights.end()) >= 0;
}

/** Whether planes through the two points, square to the line between them, part the triangles up to rounding: no pair is closer then. */
bool isClosest(const ClosestPair& candidate, const Triangle& a, const Triangle& b, double rounding) {
  const Vector3 line = candidate.point_b - candidate.point_a;
  const double slack = rounding * std::sqrt(candidate.squared_distance);
  const double reach_a = line.dot(candidate.point_a) + slack, reach_b = line.dot(candidate.point_b) - slack;
  for (int k = 0; k < 3; ++k) {
    // Written so that an empty candidate, which is NaN, proves nothing.
    if (!(line.dot(a[k]) <= reach_a && line.dot(b[k]) >= reach_b)) return false;
  }
  return true;
}

/** The least over insides and corners, then over pairs of sides; stops where the planes prove that it is found. */
ClosestPair closestFeatures(const Face& a, const Face& b, double rounding) {
  const Triangle &ta = a.corners, &tb = b.corners;
  ClosestPair best;
  for (int i = 0; i < 3; ++i) {
    if (b.holdsProjectionOf(ta[i])) best.improve(ta[i], b.projection(ta[i]));
    if (a.holdsProjectionOf(tb[i])) best.improve(a.projection(tb[i]), tb[i]);
  }
  if (isClosest(best, ta, tb, rounding)) return best;
  const std::array<Segment, 3> sides_a = {Segment(ta[0], ta[1]), Segment(ta[1], ta[2]), Segment(ta[2], ta[0])};
  const std::array<Segment, 3> sides_b = {Segment(tb[0], tb[1]), Segment(tb[1], tb[2]), Segment(tb[2], tb[0])};
  for (const Segment& side_a : sides_a) {
    for (const Segment& side_b : sides_b) {
      const double before = best.squared_distance;
      improveBySides(side_a, side_b, &best);
      if (best.squared_distance < before && isClosest(best, ta, tb, rounding)) return best;
    }
  }
  return best;
}

}  // namespace

ClosestPoints closestPointTriangle(const Vector3& p, const Triangle& t) {
  const Face face(t);
  if (face.holdsProjectionOf(p)) {
    const Vector3 q = face.projection(p);
    return {(p - q).norm(), p, q};
  }
  ClosestPair best;
  for (int k = 0; k < 3; ++k) best.improve(p, closestOnSegment(p, t[k], t[(k + 1) % 3]));
  return best.result();
}

ClosestPoints closestSegmentSegment(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1) {
  ClosestPair best;
  improveBySides(Segment(a0, a1), Segment(b0, b1), &best);
  return best.result();
}

ClosestPoints closestTriangleTriangle(const Triangle& a, const Triangle& b) {
  const Face face_a(a), face_b(b);
  const std::array<double, 3> heights_a = heightsOver(face_b, a), heights_b = heightsOver(face_a, b);
  // A flat triangle has no sides to be on.
  if ((face_b.flat || straddles(heights_a)) && (face_a.flat || straddles(heights_b))) {
    Vector3 crossing;
    if (crossingPoint(a, heights_a, face_b, &crossing) || crossingPoint(b, heights_b, face_a, &crossing)) {
      return {0, crossing, crossing};
    }
  }
  const double rounding = RELATIVE_ROUNDING * std::max(largestCoordinate(a), largestCoordinate(b));
  const ClosestPair best = closestFeatures(face_a, face_b, rounding / 16);
  // Triangles that meet within a plane or along a side have a distance of rounding's size; its direction would mean nothing.
  if (best.squared_distance <= rounding * rounding) return {0, best.point_a, best.point_a};
  return best.result();
}

bool segmentCrossesTriangle(const Vector3& p, const Vector3& q, const Triangle& t) {
  // Most segments lie on one side.
  const Face face(t);
  const double height_p = face.height(p), height_q = face.height(q);
  const double rounding =
      2 * RELATIVE_ROUNDING * std::sqrt(face.normal2) * std::max({largestCoordinate(t), p.cwiseAbs().maxCoeff(), q.cwiseAbs().maxCoeff()});
  if (!face.flat && (std::min(height_p, height_q) > rounding || std::max(height_p, height_q) < -rounding)) return false;
  return closestTriangleTriangle({p, q, q}, t).distance == 0;
}

ClosestPoints closestMeshMeshBruteForce(const TriangleMesh& a, const TriangleMesh& b, const Pose& X_BA) {
  ClosestPoints best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const Vector3i& ea : a.elements) {
    const Triangle triangle_a = {X_BA * a.vertices[ea[0]], X_BA * a.vertices[ea[1]], X_BA * a.vertices[ea[2]]};
    for (const Vector3i& eb : b.elements) {
      const ClosestPoints pair = closestTriangleTriangle(triangle_a, {b.vertices[eb[0]], b.vertices[eb[1]], b.vertices[eb[2]]});
      if (pair.distance < best.distance) best = pair;
    }
  }
  return best;
}

}  // namespace blem_sim::geometry
