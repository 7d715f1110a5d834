#include "border_kind.h"

#include <algorithm>

#include "feature_cones.h"

namespace blem_sim {
namespace {

/** Seen from where `slope` is positive: how steeply (sine) the steepest of a face's neighbours over an edge rises out of its plane. */
BorderKind kindOf(bool is_round, double slope) {
  if (slope > CONE_SLACK) return slope > NEAR_SUCCESSOR ? BorderKind::RISING : BorderKind::TURNING;
  return is_round ? BorderKind::ROUND : BorderKind::FALLING;
}

}  // namespace

BorderKinds borderKinds(const MeshSide& side, int face, SurroundingsMemory* surroundings) {
  BorderKinds kinds;
  const Vector3 normal = MeshTopology::normal(side.mesh, face);
  for (int k = 0; k < 3; ++k) {
    const int edge = side.topology.edgeOf(face, k);
    kinds.of[0][k] = kinds.of[1][k] = BorderKind::FLAT;
    if (side.topology.isFlatEdge(edge)) continue;
    double above = -1, below = -1;
    const EdgeFaces faces = side.topology.facesOf(edge);
    const int* neighbour = faces.begin();
    forEachInward(side, edge, surroundings, [&](const Vector3& inward) {
      if (side.topology.patchOf(*neighbour++) == side.topology.patchOf(face)) return;
      const double slope = inward.dot(normal);
      above = std::max(above, slope);
      below = std::max(below, -slope);
    });
    const bool is_round = surroundings->ofEdge(side, edge).is_round;
    kinds.of[1][k] = kindOf(is_round, above);
    kinds.of[0][k] = kindOf(is_round, below);
  }
  return kinds;
}

kernels::OpenSides openSides(const BorderKinds& kinds) {
  const auto from = [](const BorderKind(&of)[3]) {
    int open = 0;
    bool fades = false;
    for (int k = 0; k < 3; ++k) {
      open |= (of[k] > BorderKind::ROUND) << k;
      fades = fades || of[k] == BorderKind::FALLING || of[k] == BorderKind::RISING;
    }
    return fades ? open : 0;
  };
  return from(kinds.of[1]) | from(kinds.of[0]) << 3;
}

}  // namespace blem_sim
