#include "border_kind.h"

#include <algorithm>

#include "feature_cones.h"

namespace blem_sim {
namespace {

/** How steeply (sine) the face's neighbours over an edge rise out of its plane towards `up`, the mesh's frame; negative where they fall. */
double neighbourSlope(const MeshSide& side, int face, int edge, const Vector3& up) {
  double slope = -1;
  for (const int neighbour : side.topology.facesOf(edge)) {
    if (side.topology.patchOf(neighbour) == side.topology.patchOf(face)) continue;
    slope = std::max(slope, side.topology.inward(side.mesh, edge, neighbour).dot(up));
  }
  return slope;
}

}  // namespace

BorderKind borderKind(const MeshSide& side, int face, int k, bool above) {
  const int edge = side.topology.edgeOf(face, k);
  if (side.topology.isFlatEdge(edge)) return BorderKind::FLAT;
  const Vector3 normal = MeshTopology::normal(side.mesh, face);
  const double rise = neighbourSlope(side, face, edge, above ? normal : Vector3(-normal));
  if (rise > CONE_SLACK) return rise > NEAR_SUCCESSOR ? BorderKind::RISING : BorderKind::TURNING;
  return isRoundEdge(side, edge) ? BorderKind::ROUND : BorderKind::FALLING;
}

kernels::OpenSides openSides(const MeshSide& side, int face) {
  kernels::OpenSides open = 0;
  for (int k = 0; k < 3; ++k) {
    for (const bool above : {true, false}) open |= (borderKind(side, face, k, above) > BorderKind::ROUND) << (above ? k : 3 + k);
  }
  return open;
}

}  // namespace blem_sim
