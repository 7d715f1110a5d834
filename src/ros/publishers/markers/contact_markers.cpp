#include "publishers/markers/contact_markers.h"

#include <visualization_msgs/MarkerArray.h>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <utility>

#include "messages/conversions.h"

namespace blem_sim::node {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr int MARKER_QUEUE = 100;
constexpr double POINT_SIZE = 0.012;      // [m]
constexpr double SHAFT_SIZE = 0.008;      // [m]
constexpr double HEAD_SIZE = 0.02;        // [m]
constexpr double SHORTEST_ARROW = 0.002;  // [m]

Marker makeMarker(const char* name, int id, int type, const ros::Time& stamp) {
  Marker marker;
  marker.header.frame_id = WORLD_FRAME;
  marker.header.stamp = stamp;
  marker.ns = name;
  marker.id = id;
  marker.type = type;
  marker.pose.orientation.w = 1;
  return marker;
}

}  // namespace

ContactMarkers::ContactMarkers(ros::NodeHandle* private_node, const std::string& topic, double metres_per_newton)
    : publisher_(ListenedPublisher::advertise<MarkerArray>(private_node, topic, MARKER_QUEUE)), metres_per_newton_(metres_per_newton) {}

void ContactMarkers::publish(const boost::shared_ptr<StampedContacts>& contacts) {
  const auto message = boost::make_shared<MarkerArray>();
  MarkerArray& array = *message;
  array.markers.reserve(1 + std::max(contacts->contacts.size(), arrows_));
  Marker points = makeMarker("points", 0, Marker::SPHERE_LIST, contacts->stamp);
  points.scale.x = points.scale.y = points.scale.z = POINT_SIZE;
  int arrows = 0;
  for (const sim::ContactReport& contact : contacts->contacts) {
    const std_msgs::ColorRGBA colour = toColour(sim::contactColour(contact));
    points.points.push_back(toPoint(contact.point));
    points.colors.push_back(colour);
    const Vector3 force = sim::forceOnMovingSide(contact);
    const double length = std::min(LONGEST_ARROW, metres_per_newton_ * force.norm());
    if (length < SHORTEST_ARROW) continue;
    const Vector3 along = length * force.normalized();
    array.markers.push_back(makeMarker("forces", arrows++, Marker::ARROW, contacts->stamp));
    Marker& arrow = array.markers.back();
    arrow.scale.x = SHAFT_SIZE;
    arrow.scale.y = HEAD_SIZE;
    arrow.scale.z = std::min(2 * HEAD_SIZE, 0.5 * length);
    arrow.color = colour;
    arrow.points = {toPoint(contact.point), toPoint(contact.point + along)};
  }
  // A list without points is an error to rviz, so an empty one is taken away like the arrows of before.
  if (points.points.empty()) points.action = Marker::DELETE;
  array.markers.push_back(std::move(points));
  for (std::size_t old = arrows; old < arrows_; ++old) {
    Marker gone = makeMarker("forces", static_cast<int>(old), Marker::ARROW, contacts->stamp);
    gone.action = Marker::DELETE;
    array.markers.push_back(gone);
  }
  arrows_ = arrows;
  publisher_.publish(message);
}

}  // namespace blem_sim::node
