// Triangles of a shape_msgs/Mesh.
#pragma once

#include <shape_msgs/Mesh.h>

#include <cstddef>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::node {

/** Triangles and vertices beyond which a message is refused. */
constexpr std::size_t MOST_MESH_TRIANGLES = 4000000;

/**
 * The triangles of a message, in its frame [m]; vertices that none uses may be anything.
 * @throws InputError in one line: no triangle, more than MOST_MESH_TRIANGLES, an index out of range, a corner that is not finite
 */
geometry::TriangleMesh meshOf(const shape_msgs::Mesh& message);

}  // namespace blem_sim::node
