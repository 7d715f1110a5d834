// Collision geometry as it is simulated, as rviz markers.
#pragma once

#include <visualization_msgs/Marker.h>

#include <optional>
#include <string>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::node {

/** Place and looks of a collider's markers. */
struct MarkerStyle {
  std::string frame;  ///< of the markers
  Pose X_FC;          ///< pose of the geometry in it
  std_msgs::ColorRGBA colour;
  int first_id = 0;                           ///< ids count up from here
  Vector3 up = Vector3::Zero();               ///< unit, in `frame`; if not zero, points have the colours of their heights instead
  std::optional<sim::SurfaceFile> file = {};  ///< that shows the geometry
};

/** Meshes of more triangles are sent as the name of their file, where rviz can read it, and in pieces where not. */
constexpr std::size_t MOST_TRIANGLES = 100000;
constexpr std::size_t MOST_DOTS = 1000000;  ///< of a cloud in one marker

/** A marker with all but its kind and its points. */
visualization_msgs::Marker markerOf(const contact::Collider& collider, const MarkerStyle& style);

/** Adds the triangles of a mesh as lists of MOST_TRIANGLES at most. @param prototype of the lists, whose ids count up from its own */
void addTriangles(const geometry::TriangleMesh& mesh, const visualization_msgs::Marker& prototype,
                  std::vector<visualization_msgs::Marker>* markers);

/**
 * Triangles as one list, as the file they came from or as lists of MOST_TRIANGLES at most; segments as lines, points as spheres or, where
 * there are many, squares of the same size; a half-space as a square of its plane about the origin's foot point.
 */
std::vector<visualization_msgs::Marker> surfaceMarkers(const contact::Collider& collider, const MarkerStyle& style);

/** Whether rviz shows the file as it is: binary STL, PLY or OBJ, in a place whose name needs no escapes. */
bool rvizReads(const sim::SurfaceFile& file);

}  // namespace blem_sim::node
