// The common perpendicular of two edges.
#pragma once

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/types.h"
#include "tolerances.h"

namespace blem_sim {

/** Segments p0 p1 and q0 q1 where their lines are closest. */
struct EdgePair {
  Vector3 axis;              ///< unit, square to both
  double offset;             ///< [m] axis . (p - q)
  Vector3 point_p, point_q;  ///< the feet, inside both segments
};

/** Segments whose feet lie beyond an end of one or both, by little. */
struct EdgesBeyond {
  Vector3 point_p, point_q;  ///< closest points of the segments
  Vector3 normal;            ///< unit, square to both lines, from q to p
  double beyond;             ///< [m] the farther of the feet's distances from their segments
  int end_p, end_q;          ///< end beyond which the foot lies, 0 or 1; -1 if it lies inside
};

namespace edge_pair_detail {

/** Is numerator / denominator in [0, 1], or beyond it by no more than CLOSED along an edge of that squared length? */
inline bool isInside(double numerator, double denominator, double squared_length) {
  if (numerator >= 0 && numerator <= denominator) return true;
  const double beyond = numerator < 0 ? -numerator : numerator - denominator;
  return beyond * beyond * squared_length <= CLOSED * CLOSED * denominator * denominator;
}

}  // namespace edge_pair_detail

/** Where the lines through p0 p1 and q0 q1 are closest: at parts s / n2 and t / n2 of the segments. */
struct LinePair {
  Vector3 p, q, n;  ///< directions and their product
  double n2, p2, q2, rn, s, t;

  /** @return false if they are parallel, farther than `range` [m] apart, or a foot lies farther than `most` [m] beyond its segment */
  bool find(const Vector3& p0, const Vector3& p1, const Vector3& q0, const Vector3& q1, double range, double most) {
    p = p1 - p0, q = q1 - q0, n = p.cross(q);
    const Vector3 r = q0 - p0;
    n2 = n.squaredNorm(), rn = r.dot(n);
    if (rn * rn > range * range * n2) return false;
    p2 = p.squaredNorm(), q2 = q.squaredNorm();
    if (n2 <= MIN_EDGE_SINE * MIN_EDGE_SINE * p2 * q2) return false;
    const double most2 = most * most * n2 * n2;
    s = r.cross(q).dot(n);
    if (overshoot2(s) * p2 > most2) return false;
    t = r.cross(p).dot(n);
    return overshoot2(t) * q2 <= most2;
  }

  /** Square of how far a foot lies beyond its segment, in units of the segment / n2. */
  double overshoot2(double foot) const {
    const double over = foot < 0 ? -foot : foot > n2 ? foot - n2 : 0;
    return over * over;
  }
};

/** @return false if a foot lies outside its segment */
inline bool findEdgePair(const LinePair& lines, const Vector3& p0, const Vector3& q0, EdgePair* out) {
  if (!edge_pair_detail::isInside(lines.s, lines.n2, lines.p2) || !edge_pair_detail::isInside(lines.t, lines.n2, lines.q2)) return false;
  const double norm = std::sqrt(lines.n2);
  out->axis = lines.n / norm;
  out->offset = -lines.rn / norm;
  out->point_p = p0 + lines.s / lines.n2 * lines.p;
  out->point_q = q0 + lines.t / lines.n2 * lines.q;
  return true;
}

/** @return false if they are parallel, farther than `range` [m] apart, or a foot lies outside its segment */
inline bool findEdgePair(const Vector3& p0, const Vector3& p1, const Vector3& q0, const Vector3& q1, double range, EdgePair* out) {
  LinePair lines;
  return lines.find(p0, p1, q0, q1, range, CLOSED) && findEdgePair(lines, p0, q0, out);
}

/** For segments that findEdgePair refuses. */
inline void findEdgesBeyond(const LinePair& lines, const Vector3& p0, const Vector3& q0, EdgesBeyond* out) {
  const double n2 = lines.n2, over_p2 = lines.overshoot2(lines.s), over_q2 = lines.overshoot2(lines.t);
  out->beyond = std::sqrt(std::max(over_p2 * lines.p2, over_q2 * lines.q2)) / n2;
  out->end_p = over_p2 == 0 ? -1 : lines.s > 0;
  out->end_q = over_q2 == 0 ? -1 : lines.t > 0;
  out->normal = lines.n * ((lines.rn > 0 ? -1 : 1) / std::sqrt(n2));
  // Clamped one after the other: exact where one foot lies inside.
  const auto clamped = [](double part) { return std::min(std::max(part, 0.0), 1.0); };
  out->point_p = p0 + clamped(lines.s / n2) * lines.p;
  out->point_q = q0 + clamped((out->point_p - q0).dot(lines.q) / lines.q2) * lines.q;
  out->point_p = p0 + clamped((out->point_q - p0).dot(lines.p) / lines.p2) * lines.p;
}

}  // namespace blem_sim
