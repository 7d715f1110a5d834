// Directions in which a vertex can be the nearest point of its surface.
#pragma once

#include "kernels/records.h"
#include "mesh_pair.h"
#include "surroundings.h"

namespace blem_sim {

/** Cone that holds every direction, in the mesh's frame, that vertexConeAllows. */
kernels::VertexCone vertexCone(const MeshSide& side, int vertex, SurroundingsMemory* surroundings);

}  // namespace blem_sim
