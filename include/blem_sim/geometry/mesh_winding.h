// Which side of a closed mesh is its outside, told by the order of its triangles' corners.
#pragma once

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/**
 * Turns triangles so that all closed parts of a mesh, those that edges join, show their outside alike. Within a part most triangles decide.
 * A part inside another keeps its sense against the outermost one around it, so that a cavity stays one. The sequence of triangles stays.
 * @return the mesh as it is where some edge has not two triangles, or a part has but one side, as Klein's bottle
 */
TriangleMesh woundOutward(TriangleMesh mesh);

}  // namespace blem_sim::geometry
