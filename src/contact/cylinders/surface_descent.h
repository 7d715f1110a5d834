// From a feature of a surface that a cylinder is near to the one where it is nearest.
#pragma once

#include "blem_sim/contact/collider.h"
#include "blem_sim/geometry/cylinder.h"
#include "features/mesh_pair.h"

namespace blem_sim::contact {

/** Feature of a surface, and the points of it and of a cylinder that are nearest; in the cylinder's frame. */
struct NearestPlace {
  Feature feature;
  Vector3 on_cylinder, on_surface;  ///< [m]
  int triangle = -1;                ///< of a face, below or near on_surface
};

/** Nearest point of mantle or rim to q, in the cylinder's frame. @return false if it is on a flat end, or q is inside */
bool projectOnto(const geometry::Cylinder& cylinder, const Vector3& q, Vector3* x);

/** Whether a point of mantle or rim lies on a rim. */
bool isAtRim(const geometry::Cylinder& cylinder, const Vector3& x);

/**
 * Walks from feature to feature of a surface as a cylinder's distance leads it: where the way between nearest points leads into a face
 * beside their edge, to the rim's lowest point over that face; where that point lies beyond the face's plane, to the edge between, or on to
 * the next face of a shallow valley. So what a side of the mesh meets, up to half a side beside, becomes what the cylinder meets.
 */
class SurfaceDescent {
 public:
  /** @param surface a mesh, not a half-space @param X_KO its pose in the cylinder's frame @param rolls sine of the lean between end and
   * surface from which on rims roll; below it the way goes no further */
  SurfaceDescent(const geometry::Cylinder& cylinder, const CollisionGeometry& surface, const Pose& X_KO, double rolls)
      : cylinder_(cylinder), surface_(surface), X_KO_(X_KO), rolls_(rolls) {}

  /** Sets the nearest points of the cylinder and a vertex or an edge, from those at hand on. @return false if none is on mantle or rim */
  bool approach(NearestPlace* place) const;

  /** Goes on from a vertex or an edge that was approached. @return false if the way does not end, and place means nothing */
  bool descend(NearestPlace* place) const;

  /** The same from a face. @param place points above each other @param up unit, from the face to the cylinder */
  bool descendFrom(const Vector3& up, NearestPlace* place) const;

 private:
  Vector3 vertex(int index) const { return X_KO_ * surface_.mesh().vertices[index]; }
  Vector3 into(int edge, int face) const { return X_KO_.linear() * surface_.topology().inward(surface_.mesh(), edge, face); }
  void approachEdge(int edge, Vector3* q) const;
  void stayNear(const Vector3& start, const Vector3& along, Vector3* q) const;
  Vector3 beyond(const Vector3& q) const;
  bool findNext(const Vector3& towards, NearestPlace* place) const;
  bool findEdgeAt(int vertex, const Vector3& towards, NearestPlace* place) const;
  bool findFaceBeside(const Vector3& towards, NearestPlace* place) const;
  enum class OverFace { STAYS, LEAVES, NOT_ROLLING };
  OverFace overFace(const Vector3& towards, NearestPlace* place) const;
  int putLowest(const Vector3& up, NearestPlace* place) const;
  int triangleNear(const NearestPlace& place) const;
  int leftOver(const Vector3& from, const Vector3& to, int* triangle) const;
  double steepestBeside(int edge, const Vector3& up, int* face) const;

  const geometry::Cylinder& cylinder_;
  const CollisionGeometry& surface_;
  const Pose X_KO_;
  const double rolls_;
};

}  // namespace blem_sim::contact
