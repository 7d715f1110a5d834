// Noise of a scan, from its triangles alone.
#pragma once

#include "blem_sim/geometry/mesh_topology.h"

namespace blem_sim::sim {

/**
 * Standard deviation [m] of the noise that displaces each vertex for itself: a smooth surface passes a second difference over the rings of
 * neighbours nearly as zero, noise does not. Roughness that the triangles are too large to resolve counts as noise. Estimated at 5,000
 * vertices at most, inside the surface and away from edges of more than 60 degrees, as the median of absolute values.
 * @return 0 for a mesh with fewer than 300 such vertices
 */
double scanNoise(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology);

}  // namespace blem_sim::sim
