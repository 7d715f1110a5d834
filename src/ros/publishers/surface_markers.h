// Collision geometry as it is simulated, as rviz markers.
#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "blem_sim/contact/collider.h"

namespace blem_sim::node {

/**
 * Triangles in lists of at most 60,000 corners (rviz and the transport choke on single huge markers), segments as lines, points as spheres
 * or, where there are many, squares of the same size; a half-space as a square of its plane about the origin's foot point.
 * @param frame of the markers; @param X_FC pose of the geometry in it; @param first_id ids count up from here
 * @param up unit, in `frame`; if not zero, points have the colours of their heights instead
 */
std::vector<visualization_msgs::Marker> surfaceMarkers(const contact::Collider& collider, const std::string& frame, const Pose& X_FC,
                                                       const std_msgs::ColorRGBA& colour, int first_id,
                                                       const Vector3& up = Vector3::Zero());

}  // namespace blem_sim::node
