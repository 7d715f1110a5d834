#include "evaluation/leaving_vertex.h"

#include <algorithm>
#include <cmath>

#include "features/feature_cones.h"
#include "kernels/kernels.h"

namespace blem_sim::contact {
namespace {

/** Largest part (sine) along `direction` (unit, mesh's frame) of the faces of an edge: slope of its surface that way; -1 without faces. */
double slopeOf(const MeshSide& side, int edge, const Vector3& direction, SurroundingsMemory* surroundings) {
  double slope = -1;
  forEachInward(side, edge, surroundings, [&](const Vector3& u) { slope = std::max(slope, u.dot(direction)); });
  return slope;
}

}  // namespace

bool isTakenOver(const LeavingVertex& leaving, SurroundingsMemory* surroundings) {
  const MeshSide& side = leaving.side;
  if (side.topology.isStraightVertex(leaving.vertex)) return true;
  const Vector3 along = leaving.R_PS.transpose() * surroundings->ofEdge(leaving.partner, leaving.edge).direction;
  const Vector3 across = leaving.normal.cross(along);
  const auto partnerAllows = [&](const Vector3& normal, double slack) {
    return edgeConeAllows(leaving.partner, leaving.edge, -(leaving.R_PS * normal), slack, surroundings);
  };
  const EdgesAtVertex edges = surroundings->ofVertex(side, leaving.vertex);
  const kernels::LeadingEdges leading =
      kernels::kernels().leadingEdges(edges.blocks, edges.block_count, leaving.normal.data(), across.data());
  if (!leading.down) return partnerAllows(leaving.normal, CONE_SLACK);
  if (!leading.near) return false;
  for (const EdgeFromVertex& edge : edges) {
    const double down = edge.along.dot(leaving.normal), aside = edge.along.dot(across), length2 = edge.length2;
    if (edge.is_flat || down <= 0 || down * down <= CONE_SLACK * CONE_SLACK * length2) continue;
    // Edges whose foot lies farther from the vertex than a successor, as part of the contact's length, take nothing over.
    const double span2 = down * down + aside * aside;
    if (down * down * length2 > NEAR_SUCCESSOR * NEAR_SUCCESSOR * span2 * span2) continue;
    const Vector3 normal = (leaving.normal * std::abs(aside) - across * (aside > 0 ? down : -down)) / std::sqrt(span2);
    if (slopeOf(side, edge.edge, normal, surroundings) <= EDGE_CONE_SLACK && partnerAllows(normal, EDGE_CONE_SLACK)) return true;
  }
  return false;
}

bool edgeConeAllows(const MeshSide& side, int edge, const Vector3& direction, double slack, SurroundingsMemory* surroundings) {
  bool allows = true;
  forEachInward(side, edge, surroundings, [&](const Vector3& u) { allows = allows && u.dot(direction) <= slack; });
  return allows;
}

}  // namespace blem_sim::contact
