// Outside of a boundary layer as triangles.
#pragma once

#include "blem_sim/geometry/mesh_topology.h"

namespace blem_sim {

/** All that is a distance away from the triangles of a mesh, on both sides, round at edges that are not flat; corners are left open. @param
 * r [m] */
geometry::TriangleMesh layerShell(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology, double r);

}  // namespace blem_sim
