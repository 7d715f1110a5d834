// A face in the frame of the search, and the places of points relative to it.
#pragma once

#include <cstdint>

#include "features/edge_pair.h"
#include "features/mesh_pair.h"

namespace blem_sim::contact {

/** A face as the exact tests want it, in frame F. */
struct FaceShape {
  Vector3 corners[3];
  Vector3 normal;     ///< unit
  Vector3 inward[3];  ///< in its plane, square to side k (corners k and k + 1), into it; as long as the side
  double length2[3];  ///< [m^2] of the sides
  int element;
};

inline constexpr int NEXT[3] = {1, 2, 0};

inline FaceShape faceShape(const MeshPair& pair, Side face_side, int element) {
  const MeshSide& side = pair.side(face_side);
  FaceShape shape;
  shape.element = element;
  for (int k = 0; k < 3; ++k) shape.corners[k] = pair.placed(side.mesh.vertices[side.mesh.elements[element][k]], face_side);
  shape.normal = pair.turned(geometry::MeshTopology::normal(side.mesh, element), face_side);
  for (int k = 0; k < 3; ++k) {
    const Vector3 along = shape.corners[NEXT[k]] - shape.corners[k];
    shape.inward[k] = shape.normal.cross(along);
    shape.length2[k] = along.squaredNorm();
  }
  return shape;
}

inline Vector3 middle(const Vector3 corners[3]) { return (corners[0] + corners[1] + corners[2]) / 3; }

/** Distance of p's projection inside the face's side k, times the side's length [m^2]; negative outside. */
inline double insideSide(const FaceShape& face, int k, const Vector3& p) { return face.inward[k].dot(p - face.corners[k]); }

/** Whether p projects into the face, or beside it by no more than CLOSED. */
inline bool holdsProjection(const FaceShape& face, const Vector3& p) {
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

}  // namespace blem_sim::contact
