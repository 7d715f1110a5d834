#include "neighbourhood/plane_reach.h"

#include <algorithm>
#include <limits>

#include "features/tolerances.h"
#include "kernels/vectors.h"
#include "neighbourhood/leaf_features.h"

namespace blem_sim::contact {
namespace {

using kernels::FaceRecord;

/** The faces of a plane, but not of one with many. */
struct PlaneFaces {
  static constexpr int MOST = 64;

  PlaneFaces(const geometry::MeshTopology& topology, int face) : of{face} {
    for (int i = 0; i < count && !are_many; ++i)
      for (int k = 0; k < 3; ++k) addBehind(topology, topology.edgeOf(of[i], k));
  }
  void addBehind(const geometry::MeshTopology& topology, int edge) {
    if (!topology.isFlatEdge(edge)) return;
    for (const int face : topology.facesOf(edge)) {
      if (std::find(of, of + count, face) != of + count) continue;
      are_many = are_many || count == MOST;
      if (!are_many) of[count++] = face;
    }
  }

  int of[MOST], count = 1;
  bool are_many = false;
};

/** Sharpness of a face: points outside each side by no more than 1 lie within 1 / sharpness of the face. */
double sharpness(const FaceRecord& face) {
  double least = 1;
  for (int k = 0; k < 3; ++k) least = std::min(least, 0.5 * vector3(face.sides[k]).cross(vector3(face.sides[(k + 1) % 3])).norm());
  return least;
}

}  // namespace

PlaneReach planeReach(const MeshSide& side, int face) {
  const PlaneFaces faces(side.topology, face);
  if (faces.are_many) return {std::numeric_limits<double>::infinity(), 0};
  const FaceRecord own = faceRecord(side, face);
  const Vector3 normal = vector3(own.plane);
  PlaneReach reach{0, 0};
  for (int i = 1; i < faces.count; ++i) {
    const FaceRecord other = faceRecord(side, faces.of[i]);
    const Vector3 up = vector3(other.plane);
    reach.per_height = std::max(reach.per_height, std::min((up - normal).norm(), (up + normal).norm()));
    for (int k = 0; k < 3; ++k) {
      if (side.topology.isFlatEdge(side.topology.edgeOf(face, k))) continue;
      for (int corner = 0; corner < 3; ++corner) {
        const Vector3& point = side.mesh.vertices[side.mesh.elements[faces.of[i]][corner]];
        const double outside = own.sides[k].w - vector3(own.sides[k]).dot(point);
        reach.flat = std::max(reach.flat, outside + 3 * CLOSED / sharpness(other));  // vertices over it may lie so little beside it
      }
    }
  }
  return {reach.flat / sharpness(own), reach.per_height / sharpness(own)};
}

}  // namespace blem_sim::contact
