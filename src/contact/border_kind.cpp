#include "border_kind.h"

#include <algorithm>

#include "feature_cones.h"

namespace blem_sim {
namespace {

/** How steeply (sine) the face's neighbours over an edge rise out of its plane; negative where they fall. */
struct NeighbourSlopes {
  NeighbourSlopes(const MeshSide& side, int face, int edge) {
    const Vector3 normal = MeshTopology::normal(side.mesh, face);
    for (const int neighbour : side.topology.facesOf(edge)) {
      if (side.topology.patchOf(neighbour) == side.topology.patchOf(face)) continue;
      const double slope = side.topology.inward(side.mesh, edge, neighbour).dot(normal);
      above = std::max(above, slope);
      below = std::max(below, -slope);
    }
  }
  double above = -1, below = -1;  ///< seen from there
};

bool rises(double slope) { return slope > CONE_SLACK; }

}  // namespace

BorderKind borderKind(const MeshSide& side, int face, int k, bool above) {
  const int edge = side.topology.edgeOf(face, k);
  if (side.topology.isFlatEdge(edge)) return BorderKind::FLAT;
  const NeighbourSlopes slopes(side, face, edge);
  const double slope = above ? slopes.above : slopes.below;
  if (rises(slope)) return slope > NEAR_SUCCESSOR ? BorderKind::RISING : BorderKind::TURNING;
  return isRoundEdge(side, edge) ? BorderKind::ROUND : BorderKind::FALLING;
}

kernels::OpenSides openSides(const MeshSide& side, int face) {
  kernels::OpenSides open = 0;
  for (int k = 0; k < 3; ++k) {
    const int edge = side.topology.edgeOf(face, k);
    if (side.topology.isFlatEdge(edge)) continue;
    const NeighbourSlopes slopes(side, face, edge);
    const bool sharp = !isRoundEdge(side, edge);
    open |= (rises(slopes.above) || sharp) << k | (rises(slopes.below) || sharp) << (3 + k);
  }
  return open;
}

}  // namespace blem_sim
