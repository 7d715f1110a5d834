// An element in the frame of the search, and where points lie to it.
#pragma once

#include <cstdint>

#include "edge_pair.h"
#include "mesh_pair.h"

namespace blem_sim {

/** An element as the tests want it, in frame F. */
struct ElementShape {
  Vector3 corners[3];
  Vector3 lower, upper;  ///< its box
  Vector3 normal;        ///< unit; the following are meaningless unless is_face
  Vector3 inward[3];     ///< in its plane, square to side k (corners k and k + 1), into it; as long as the side
  double length2[3];     ///< [m^2] of the sides
  bool is_fat;           ///< inward is sure and exact
  int element;
  bool is_face, is_described;
  std::uint8_t vertices, edges;  ///< bits of the corners and of the sides that it owns
};

inline constexpr int NEXT[3] = {1, 2, 0};

inline void findBox(ElementShape* shape) {
  shape->lower = shape->corners[0].cwiseMin(shape->corners[1]).cwiseMin(shape->corners[2]);
  shape->upper = shape->corners[0].cwiseMax(shape->corners[1]).cwiseMax(shape->corners[2]);
}

/** All but corners, box and element. @param R turns directions of the mesh into the frame of the corners; null if they are the same */
inline void describe(const MeshTopology& topology, const Matrix3* R, ElementShape* shape) {
  shape->is_described = true;
  shape->is_face = topology.isFace(shape->element);
  shape->vertices = topology.ownedVertices(shape->element);
  shape->edges = topology.ownedEdges(shape->element);
  if (!shape->is_face) return;
  constexpr double FAT = 1e-4;  // smallest height of a fat triangle over its longest side
  shape->normal = R ? Vector3(*R * topology.normals[shape->element]) : topology.normals[shape->element];
  for (int k = 0; k < 3; ++k) {
    const Vector3 side = shape->corners[NEXT[k]] - shape->corners[k];
    shape->inward[k] = shape->normal.cross(side);
    shape->length2[k] = side.squaredNorm();
  }
  const double area = shape->inward[0].dot(shape->corners[2] - shape->corners[0]);
  shape->is_fat = area > FAT * std::max({shape->length2[0], shape->length2[1], shape->length2[2]});
}

inline bool boxesWithin(const Vector3& lower, const Vector3& upper, const ElementShape& f, double range) {
  bool within = true;
  for (int k = 0; k < 3; ++k) within &= (lower[k] - f.upper[k] <= range) & (f.lower[k] - upper[k] <= range);
  return within;
}

inline bool oneSided(const double heights[3], double range) {
  return std::min(std::min(heights[0], heights[1]), heights[2]) > range || std::max(std::max(heights[0], heights[1]), heights[2]) < -range;
}

inline Vector3 middle(const Vector3 corners[3]) { return (corners[0] + corners[1] + corners[2]) / 3; }

/** How far p projects inside the face's side k, times the side's length; negative outside. */
inline double insideSide(const ElementShape& face, int k, const Vector3& p) { return face.inward[k].dot(p - face.corners[k]); }

/** Does p project into the face, or beside it by no more than CLOSED? */
inline bool holdsProjection(const ElementShape& face, const Vector3& p) {
  for (int k = 0; k < 3; ++k) {
    const double inside = insideSide(face, k, p);
    if (inside >= 0) continue;
    // Beside it, and not beyond a sharp corner, where two strips of that width meet far out.
    const double length2 = face.length2[k];
    if (inside * inside > CLOSED * CLOSED * length2) return false;
    const Vector3 side = face.corners[NEXT[k]] - face.corners[k];
    if (!edge_pair_detail::isInside(side.dot(p - face.corners[k]), length2, length2)) return false;
  }
  return true;
}

/** May p project into the face, or beside it by no more than `most` [m]? False only if it is farther out, whatever the rounding. */
inline bool mayHoldProjection(const ElementShape& face, const Vector3& p, double most) {
  const double limit2 = (most + 2 * CLOSED) * (most + 2 * CLOSED);
  int outside = 0;
  for (int k = 0; k < 3; ++k) {
    const double inside = insideSide(face, k, p);
    outside |= static_cast<int>(inside * std::abs(inside) < -limit2 * face.length2[k]);
  }
  return outside == 0;
}

}  // namespace blem_sim
