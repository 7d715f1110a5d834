// Boundary layers as rviz shows them.
#pragma once

#include <visualization_msgs/Marker.h>

#include "blem_sim/geometry/triangle_mesh.h"
#include "publishers/markers/surface_markers.h"

namespace blem_sim::node {

/**
 * Outside of a boundary layer, light enough for a robot of 100,000 triangles. Where neighbours are wound alike, vertices move so that all
 * their faces move by r, sharp ones by 2 r at most (layers are round there): outwards if the mesh is closed, else to both sides. In other
 * soups each face moves on its own, to both sides.
 * @param r [m]
 */
geometry::TriangleMesh movedShell(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology, double r);

/**
 * The shell of a collider's triangles, translucent, of a colour between the style's and blue; none if it has none, no width, or its layer
 * inside.
 */
std::vector<visualization_msgs::Marker> layerMarkers(const contact::Collider& collider, MarkerStyle style);

}  // namespace blem_sim::node
