// Patches that are planes but for noise.
#pragma once

#include <vector>

#include "blem_sim/geometry/mesh_mending.h"
#include "blem_sim/geometry/mesh_topology.h"

namespace blem_sim {

/**
 * Moves the vertices of nearly planar patches onto their planes; what is planar already stays.
 * @param topology of the mesh @param noise per vertex: [m] how far its place is known to be wrong; empty: nothing is known
 */
void flattenPlanes(const MeshTopology& topology, const std::vector<double>& noise, TriangleMesh* mesh, MeshMending* what);

}  // namespace blem_sim
