// An element in the frame of the search, and where points lie to it.
#pragma once

#include "edge_pair.h"

namespace blem_sim {

/** An element as the tests want it, in frame F. */
struct ElementShape {
  Vector3 corners[3];
  Vector3 lower, upper;  ///< its box
  Vector3 normal;        ///< unit; meaningless unless is_face
  int element;
  bool is_face, owns_vertices, owns_edges;
};

inline constexpr int NEXT[3] = {1, 2, 0};

inline void findBox(ElementShape* shape) {
  shape->lower = shape->corners[0].cwiseMin(shape->corners[1]).cwiseMin(shape->corners[2]);
  shape->upper = shape->corners[0].cwiseMax(shape->corners[1]).cwiseMax(shape->corners[2]);
}

inline bool boxesWithin(const Vector3& lower, const Vector3& upper, const ElementShape& f, double range) {
  return ((lower - f.upper).array() <= range).all() && ((f.lower - upper).array() <= range).all();
}

inline bool oneSided(const double heights[3], double range) {
  return (heights[0] > range && heights[1] > range && heights[2] > range) ||
         (heights[0] < -range && heights[1] < -range && heights[2] < -range);
}

inline Vector3 middle(const Vector3 corners[3]) { return (corners[0] + corners[1] + corners[2]) / 3; }

/** How far p projects inside the face's side k, times the side's length; negative outside. */
inline double insideSide(const ElementShape& face, int k, const Vector3& side, const Vector3& p) {
  return face.normal.cross(side).dot(p - face.corners[k]);
}

/** Does p project into the face, or beside it by no more than CLOSED? */
inline bool holdsProjection(const ElementShape& face, const Vector3& p) {
  for (int k = 0; k < 3; ++k) {
    const Vector3 side = face.corners[NEXT[k]] - face.corners[k];
    const double inside = insideSide(face, k, side, p);
    if (inside >= 0) continue;
    // Beside it, and not beyond a sharp corner, where two strips of that width meet far out.
    const double length2 = side.squaredNorm();
    if (inside * inside > CLOSED * CLOSED * length2) return false;
    if (!edge_pair_detail::isInside(side.dot(p - face.corners[k]), length2, length2)) return false;
  }
  return true;
}

}  // namespace blem_sim
