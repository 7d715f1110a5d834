// Normals that let a mesh of triangles look smooth where it is.
#pragma once

#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim {

/**
 * Unit normals, one per corner of each triangle: the mean over the triangles at its vertex that lie within 40 degrees of its own, weighted
 * by area. Windings may differ. Precondition: triangles only.
 */
std::vector<Vector3> cornerNormals(const geometry::TriangleMesh& mesh);

}  // namespace blem_sim
