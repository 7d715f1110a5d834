#include "border_fade.h"

#include <algorithm>

#include "blem_sim/geometry/closest_points.h"
#include "feature_cones.h"

namespace blem_sim {
namespace {

/** How steeply (sine) the face's neighbours over side k rise out of its plane towards `up`, the mesh's frame; negative where they fall. */
double neighbourSlope(const MeshSide& side, int face, int edge, const Vector3& up) {
  double slope = -1;
  for (int i = side.topology.edge_face_begin[edge]; i < side.topology.edge_face_begin[edge + 1]; ++i) {
    const int neighbour = side.topology.edge_faces[i];
    if (side.topology.patch[neighbour] == side.topology.patch[face]) continue;
    slope = std::max(slope, side.topology.inward(side.mesh, edge, neighbour).dot(up));
  }
  return slope;
}

}  // namespace

bool fadeOverBorder(const MeshPair& pair, bool vertex_moves, int vertex, const Vector3& p, double height, const ElementShape& face,
                    double most, BorderFade* out) {
  const MeshSide &vertex_side = vertex_moves ? pair.moving : pair.fixed, &face_side = vertex_moves ? pair.fixed : pair.moving;
  const Matrix3 R_FM = pair.X_FM.linear();
  const Vector3 projection = p - height * face.normal;
  const Vector3 up = height > 0 ? face.normal : Vector3(-face.normal);
  const Vector3 face_up = vertex_moves ? up : Vector3(R_FM.transpose() * up);
  const Vector3 down = vertex_moves ? Vector3(R_FM.transpose() * -up) : Vector3(-up);
  int borders = 0;  // bits of the sides outside which p projects
  for (int k = 0; k < 3; ++k) {
    const Vector3 side = face.corners[NEXT[k]] - face.corners[k];
    const double outside = side.cross(face.normal).dot(projection - face.corners[k]);
    if (outside <= 0) continue;
    if (FADE_SLOPE * FADE_SLOPE * outside * outside > most * most * side.squaredNorm()) return false;
    // Beyond a flat side the plane goes on, and is asked there.
    if (face_side.topology.edge_flat[face_side.topology.element_edges[face.element][k]]) return false;
    borders |= 1 << k;
  }
  if (borders == 0) return false;
  bool fades = false;
  for (int k = 0; k < 3; ++k) {
    if (!(borders >> k & 1)) continue;
    const int border = face_side.topology.element_edges[face.element][k];
    const double rise = neighbourSlope(face_side, face.element, border, face_up);
    // A neighbour that rises by little takes over itself.
    const LeavingVertex leaving{vertex_side, face_side, vertex, border, vertex_moves ? R_FM : Matrix3(R_FM.transpose()), down};
    fades = fades || rise > NEAR_SUCCESSOR || (rise <= CONE_SLACK && !isTakenOver(leaving));
  }
  if (!fades) return false;
  out->foot = closestPointTriangle(projection, {face.corners[0], face.corners[1], face.corners[2]}).point_b;
  out->lost = FADE_SLOPE * (projection - out->foot).norm();
  return out->lost <= most;
}

}  // namespace blem_sim
