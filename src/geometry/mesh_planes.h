// Patches that are planes but for noise.
#pragma once

#include <vector>

#include "blem_sim/geometry/mesh_mending.h"
#include "blem_sim/geometry/mesh_topology.h"

namespace blem_sim::geometry {

/**
 * Moves the vertices of nearly planar patches onto their planes; vertices of planar ones stay.
 * @param topology of the mesh @param noise per vertex: [m] known error of its place; empty: no error is known
 */
void flattenPlanes(const MeshTopology& topology, const std::vector<double>& noise, TriangleMesh* mesh, MeshMending* what);

}  // namespace blem_sim::geometry
