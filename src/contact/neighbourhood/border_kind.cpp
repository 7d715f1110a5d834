#include "neighbourhood/border_kind.h"

#include <algorithm>

#include "features/feature_cones.h"

namespace blem_sim::contact {
namespace {

/** @param slope largest sine by which a neighbour over an edge rises out of the face's plane, to the side seen; -1: no neighbour */
void addSide(bool is_round, int k, double slope, BorderKinds::Seen* seen) {
  const auto bit = static_cast<std::uint8_t>(1 << k);
  if (slope > NEAR_SUCCESSOR) {
    seen->rising |= bit;
  } else if (slope <= CONE_SLACK) {
    (is_round ? seen->round : seen->falling) |= bit;
  }
}

}  // namespace

BorderKinds borderKinds(const MeshSide& side, int face, SurroundingsMemory* surroundings) {
  BorderKinds kinds{};
  const Vector3 normal = geometry::MeshTopology::normal(side.mesh, face);
  for (int k = 0; k < 3; ++k) {
    const int edge = side.topology.edgeOf(face, k);
    if (side.topology.isFlatEdge(edge)) {
      for (BorderKinds::Seen& seen : kinds.seen) seen.flat |= static_cast<std::uint8_t>(1 << k);
      continue;
    }
    double above = -1, below = -1;
    const geometry::EdgeFaces faces = side.topology.facesOf(edge);
    const int* neighbour = faces.begin();
    forEachInward(side, edge, surroundings, [&](const Vector3& inward) {
      if (side.topology.patchOf(*neighbour++) == side.topology.patchOf(face)) return;
      const double slope = inward.dot(normal);
      above = std::max(above, slope);
      below = std::max(below, -slope);
    });
    const bool is_round = surroundings->ofEdge(side, edge).is_round;
    addSide(is_round, k, above, &kinds.seen[1]);
    addSide(is_round, k, below, &kinds.seen[0]);
  }
  return kinds;
}

kernels::OpenSides openSides(const BorderKinds& kinds) {
  const auto from = [](const BorderKinds::Seen& seen, unsigned letting) {
    return letting != 0 ? kernels::VertexFaceHit::OUTSIDE & ~(seen.flat | seen.round) : 0;
  };
  const auto of = [&](std::uint8_t BorderKinds::Seen::*also) {
    const auto seenFrom = [&](const BorderKinds::Seen& seen) { return from(seen, seen.rising | seen.*also); };
    return seenFrom(kinds.seen[1]) | seenFrom(kinds.seen[0]) << 3;
  };
  return static_cast<kernels::OpenSides>(of(&BorderKinds::Seen::falling) | of(&BorderKinds::Seen::rising) << kernels::OPEN_TO_POINTS);
}

}  // namespace blem_sim::contact
