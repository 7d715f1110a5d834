// Exact closest points of simplices, degenerate ones included.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/** Closest points of two sets; NaN until filled, so that an unfilled field shows. */
struct ClosestPoints {
  double distance = std::numeric_limits<double>::quiet_NaN();  ///< [m], 0 when they meet
  Vector3 point_a = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  Vector3 point_b = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
};

using Triangle = std::array<Vector3, 3>;  ///< corners [m]; they may coincide (a segment, a point) or be collinear

/** Corners of an element of a mesh. */
inline Triangle triangleOf(const TriangleMesh& mesh, std::size_t element) {
  const Vector3i& e = mesh.elements[element];
  return {mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]]};
}

/** Closest point of triangle t to p, and its distance. [Ericson 2005, 5.1.5], robust for collinear corners */
ClosestPoints closestPointTriangle(const Vector3& p, const Triangle& t);

/** Closest points of segments a0 a1 and b0 b1; parallel and zero-length ones included. [Lumelsky 1985; Ericson 2005, 5.1.9] */
ClosestPoints closestSegmentSegment(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1);

/** Closest points of two triangles, [Hauser 2013, Eq. 6]'s d: vertex-face, edge-edge and crossing edges. Distance 0 iff they meet. */
ClosestPoints closestTriangleTriangle(const Triangle& a, const Triangle& b);

/** Whether the segment pq crosses the interior or border of triangle t. */
bool segmentCrossesTriangle(const Vector3& p, const Vector3& q, const Triangle& t);

/** Exact distance of two meshes by testing every pair: the oracle. @param X_BA pose of A's frame in B's; the points are in B's frame */
ClosestPoints closestMeshMeshBruteForce(const TriangleMesh& a, const TriangleMesh& b, const Pose& X_BA);

}  // namespace blem_sim::geometry
