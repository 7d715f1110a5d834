// The common perpendicular of two edges.
#pragma once

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/types.h"
#include "features/tolerances.h"

namespace blem_sim::contact {

/** An edge in the frame of the search. */
struct EdgeSegment {
  const Vector3 &start, &end;  ///< [m]
};

/** Two edges p and q where their lines are closest. */
struct EdgePair {
  Vector3 axis;              ///< unit, square to both
  double offset;             ///< [m] axis . (p - q)
  Vector3 point_p, point_q;  ///< the feet, inside both segments
};

namespace edge_pair_detail {

/** Whether numerator / denominator is in [0, 1], or beyond it by no more than CLOSED along an edge of that squared length. */
inline bool isInside(double numerator, double denominator, double squared_length) {
  if (numerator >= 0 && numerator <= denominator) return true;
  const double beyond = numerator < 0 ? -numerator : numerator - denominator;
  return beyond * beyond * squared_length <= CLOSED * CLOSED * denominator * denominator;
}

}  // namespace edge_pair_detail

/** @return false if they are parallel, farther than `range` [m] apart, or a foot lies outside its segment */
inline bool findEdgePair(const EdgeSegment& edge_p, const EdgeSegment& edge_q, double range, EdgePair* out) {
  const Vector3 &p0 = edge_p.start, &q0 = edge_q.start;
  const Vector3 p = edge_p.end - p0, q = edge_q.end - q0, r = q0 - p0, n = p.cross(q);
  const double n2 = n.squaredNorm(), rn = r.dot(n), p2 = p.squaredNorm(), q2 = q.squaredNorm();
  if (rn * rn > range * range * n2 || n2 <= MIN_EDGE_SINE * MIN_EDGE_SINE * p2 * q2) return false;
  const double s = r.cross(q).dot(n), t = r.cross(p).dot(n);
  if (!edge_pair_detail::isInside(s, n2, p2) || !edge_pair_detail::isInside(t, n2, q2)) return false;
  const double norm = std::sqrt(n2);
  out->axis = n / norm;
  out->offset = -rn / norm;
  out->point_p = p0 + s / n2 * p;
  out->point_q = q0 + t / n2 * q;
  return true;
}

}  // namespace blem_sim::contact
