#include "contact_publisher.h"

#include <visualization_msgs/MarkerArray.h>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <utility>

#include "contact_colour.h"
#include "contact_messages.h"
#include "conversions.h"

namespace blem_sim {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr int QUEUE_SIZE = 100;
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

/** [N] weight of everything that moves. */
double totalWeight(const Simulator& simulator) {
  double mass = 0;
  for (const ModelInfo& model : simulator.models()) {
    for (const int body : model.bodies) {
      if (body != WORLD_BODY) mass += simulator.world().bodySpec(body).inertial.mass;
    }
  }
  return mass * std::max(1.0, simulator.gravity().norm());
}

}  // namespace

ContactPublisher::ContactPublisher(ros::NodeHandle private_node, const Simulator& simulator)
    : simulator_(simulator),
      schedule_(simulator.config().rates.contact),
      publisher_(private_node.advertise<ContactArray>("contacts", QUEUE_SIZE)) {}

void ContactPublisher::publish(const StepReport& report) {
  if (!schedule_.due(report.time) || publisher_.getNumSubscribers() == 0) return;
  publisher_.publish(toContactArray(simulator_, report));
}

ContactMarkerPublisher::ContactMarkerPublisher(ros::NodeHandle private_node, const Simulator& simulator, StepSender* sender)
    : simulator_(simulator),
      schedule_(simulator.config().rates.markers),
      publisher_(private_node.advertise<MarkerArray>("contact_markers", QUEUE_SIZE)),
      sender_(sender) {
  const double weight = totalWeight(simulator);
  metres_per_newton_ = weight > 0 ? LENGTH_OF_WEIGHT / weight : 0;
}

void ContactMarkerPublisher::publish(const StepReport& report) {
  if (!schedule_.due(report.time) || publisher_.getNumSubscribers() == 0) return;
  const ros::Time stamp = toStamp(report.time);
  const auto message = boost::make_shared<MarkerArray>();
  MarkerArray& array = *message;
  array.markers.reserve(1 + std::max(report.contacts.size(), arrows_));
  Marker points = makeMarker("points", 0, Marker::SPHERE_LIST, stamp);
  points.scale.x = points.scale.y = points.scale.z = POINT_SIZE;
  int arrows = 0;
  for (const ContactReport& contact : report.contacts) {
    const std_msgs::ColorRGBA colour = contactColour(contact);
    points.points.push_back(toPoint(contact.point));
    points.colors.push_back(colour);
    // What the moving side feels.
    const Vector3 force = contact.body_a == WORLD_BODY ? Vector3(-contact.force) : contact.force;
    const double length = std::min(LONGEST_ARROW, metres_per_newton_ * force.norm());
    if (length < SHORTEST_ARROW) continue;
    const Vector3 along = length * force.normalized();
    array.markers.push_back(makeMarker("forces", arrows++, Marker::ARROW, stamp));
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
    Marker gone = makeMarker("forces", static_cast<int>(old), Marker::ARROW, stamp);
    gone.action = Marker::DELETE;
    array.markers.push_back(gone);
  }
  arrows_ = arrows;
  sender_->add(&publisher_, message);
}

}  // namespace blem_sim
