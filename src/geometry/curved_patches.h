// Patches that bend on purpose, told from planes with noise.
#pragma once

#include <vector>

#include "blem_sim/geometry/mesh_topology.h"
#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/** A patch's least-squares plane. */
struct PatchPlane {
  Vector3 centre, normal;
  bool asked = false;  ///< whether the patch is to be looked at
};

/**
 * Whether a patch's vertices lie over its plane as those of a curved surface do. Noise differs from vertex to vertex. So a patch is curved
 * if a surface of second order leaves no more than a tenth of the heights' mean square, as under a lens or a barrel, however few its
 * vertices; or if no flat facet climbs more than half of the way from its lowest vertex to its highest, as in any fine mesh of something
 * smooth.
 * @param patch_of patch of each element; negative: none @param planes by patch
 * @return by patch; false where not asked
 */
std::vector<char> findCurved(const MeshTopology& topology, const TriangleMesh& mesh, const std::vector<int>& patch_of,
                             const std::vector<PatchPlane>& planes);

}  // namespace blem_sim::geometry
