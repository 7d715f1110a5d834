// Directions in which a vertex can be the nearest point of its surface.
#pragma once

#include <vector>

#include "features/mesh_pair.h"
#include "kernels/records.h"
#include "neighbourhood/surroundings.h"

namespace blem_sim::contact {

/** Cone that holds every direction, in the mesh's frame, that vertexConeAllows. @param room overwritten */
kernels::VertexCone vertexCone(const MeshSide& side, int vertex, SurroundingsMemory* surroundings, std::vector<double>* room);

}  // namespace blem_sim::contact
