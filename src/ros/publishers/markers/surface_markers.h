// Collision geometry as it is simulated, as rviz markers.
#pragma once

#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

#include "blem_sim/contact/collider.h"

namespace blem_sim::node {

/** Place and looks of a collider's markers. */
struct MarkerStyle {
  std::string frame;  ///< of the markers
  Pose X_FC;          ///< pose of the geometry in it
  std_msgs::ColorRGBA colour;
  int first_id = 0;              ///< ids count up from here
  Vector3 up = Vector3::Zero();  ///< unit, in `frame`; if not zero, points have the colours of their heights instead
};

/**
 * Triangles in lists of at most 60,000 corners (rviz and the transport choke on single huge markers), segments as lines, points as spheres
 * or, where there are many, squares of the same size; a half-space as a square of its plane about the origin's foot point.
 */
std::vector<visualization_msgs::Marker> surfaceMarkers(const contact::Collider& collider, const MarkerStyle& style);

}  // namespace blem_sim::node
