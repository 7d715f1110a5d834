// First hit of a ray with a mesh.
#pragma once

#include "blem_sim/geometry/ray_traversal.h"

namespace blem_sim::geometry {

struct RayHit {
  double t = std::numeric_limits<double>::infinity();  ///< in units of the ray's direction
  int element = -1;                                    ///< of the mesh; -1: no hit
};

/** A mesh as rays meet it: triangles bare and from both sides, segments and points as capsules and balls. */
struct RayMesh {
  const Bvh& tree;
  const TriangleMesh& mesh;
  double radius = 0;  ///< [m] of its segments and points
};

/** Coordinate along which a direction is longest, the first of several: rays are sheared along it. */
int longestAxis(const Vector3& direction);

/** First hit within the range, the smaller element of several. @param ray in the mesh's frame; without a direction it hits nothing */
RayHit castRay(const RayMesh& target, const Ray& ray, const RayRange& range = {});

/** First place within the range where a ray meets the surface of a ball, from outside or inside; infinity if there is none. */
double hitBall(const Ray& ray, const RayRange& range, const Vector3& centre, double radius);

/** The same for all points within `radius` of the segment from p to q. */
double hitCapsule(const Ray& ray, const RayRange& range, const std::array<Vector3, 2>& axis, double radius);

}  // namespace blem_sim::geometry
