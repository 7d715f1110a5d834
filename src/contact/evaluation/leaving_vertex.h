// A vertex whose contact leaves over an edge of the other mesh, and the contact that takes over, if one does.
#pragma once

#include "neighbourhood/surroundings.h"

namespace blem_sim::contact {

/** A vertex whose contact with an edge of the other mesh, or with a plane that ends there, leaves over that edge. */
struct LeavingVertex {
  const MeshSide &side, &partner;
  int vertex, edge;     ///< of `side`, of `partner`
  const Matrix3& R_PS;  ///< directions of side's frame in partner's
  Vector3 normal;       ///< unit, side's frame, towards the partner, square to the edge
};

/**
 * Whether another contact takes over where the vertex leaves: the vertex's own with the edge, where no edge at the vertex leads towards the
 * partner; else that of such an edge with the partner's, if it is there and not far: a plane's inner edges have none, nor have edges whose
 * contact would point into a face.
 */
bool isTakenOver(const LeavingVertex& leaving, SurroundingsMemory* surroundings);

/** edgeConeAllows of feature_cones.h, by directions that are kept. */
bool edgeConeAllows(const MeshSide& side, int edge, const Vector3& direction, double slack, SurroundingsMemory* surroundings);

}  // namespace blem_sim::contact
