#include "publishers/markers/geometry_publishers.h"

#include <blem_sim/LoadReport.h>
#include <ros/console.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <map>

#include "blem_sim/sim/drawing.h"
#include "messages/conversions.h"
#include "messages/ros_names.h"
#include "publishers/markers/layer_markers.h"

namespace blem_sim::node {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

LoadReportEntry toEntry(const geometry::MeshReport& report) {
  LoadReportEntry entry;
  entry.name = report.name;
  entry.source = report.source;
  entry.vertices = report.vertices;
  entry.triangles = report.triangles;
  entry.segments = report.segments;
  entry.points = report.points;
  entry.degenerate = report.degenerate;
  entry.duplicate = report.duplicate;
  entry.nonfinite = report.nonfinite;
  entry.invalid = report.invalid;
  entry.welded = report.welded;
  entry.open_edges = report.open_edges;
  entry.nonmanifold_edges = report.nonmanifold_edges;
  entry.closed = report.closed;
  if (!report.extents.isEmpty()) {
    entry.extents_min = toPoint(report.extents.min());
    entry.extents_max = toPoint(report.extents.max());
  }
  entry.boundary_width = report.boundary_width;
  entry.bytes = report.bytes;
  entry.notes = report.notes;
  return entry;
}

/** Markers are sent anew, so that nothing unloaded stays in sight. */
MarkerArray withoutOldOnes() {
  MarkerArray array;
  array.markers.emplace_back();
  array.markers.back().action = Marker::DELETEALL;
  array.markers.back().header.frame_id = WORLD_FRAME;
  return array;
}

/** Colliders and models as they are between two steps. */
struct Geometry {
  std::vector<contact::Collider> colliders;
  std::vector<sim::ModelInfo> models;
  Vector3 up;  // unit, for colours of clouds
};

Geometry geometryOf(const sim::Simulator& simulator) {
  return {simulator.colliders(), simulator.models(), sim::upwards(simulator.gravity())};
}

/** Adds the markers of models of a kind. @param draw markers of (collider, model, first id) */
template <typename Draw>
void addMarkers(const Geometry& geometry, sim::ModelKind kind, const Draw& draw, MarkerArray* array) {
  std::map<std::string, int> next_id;  // by collider name: an object of several shapes has several colliders of that name
  for (const contact::Collider& collider : geometry.colliders) {
    if (!collider.enabled || collider.model < 0) continue;
    const sim::ModelInfo& model = geometry.models[collider.model];
    if (!model.alive || model.kind != kind) continue;
    int& id = next_id[collider.name];
    for (Marker& marker : draw(collider, model, id)) {
      id = marker.id + 1;
      array->markers.push_back(std::move(marker));
    }
  }
}

MarkerStyle styleOf(const contact::Collider& collider, const sim::ModelInfo& model, int first_id) {
  return {model.kind == sim::ModelKind::ENVIRONMENT ? WORLD_FRAME : model.name, collider.X_BC,
          toColour(sim::modelColour(model.kind, collider.model)), first_id};
}

void tellPieces(const contact::Collider& collider, const std::string& name, std::size_t pieces) {
  const std::size_t elements = collider.seen()->mesh().elements.size();
  if (collider.seen()->hasOnlyTriangles())
    ROS_INFO(
        "%s: rviz gets its %zu triangles in %zu pieces; it draws a mesh of over %zu in one piece where that is a binary .stl, .ply or "
        ".obj file, not mirrored or joined from points",
        name.c_str(), elements, pieces, MOST_TRIANGLES);
  else
    ROS_INFO("%s: rviz gets its %zu points in %zu pieces; a voxel_grid leaves fewer than %zu", name.c_str(), elements, pieces, MOST_DOTS);
}

MarkerArray drawnEnvironments(const Geometry& geometry, std::set<std::string>* told) {
  MarkerArray array = withoutOldOnes();
  const auto draw = [&](const contact::Collider& collider, const sim::ModelInfo& model, int first_id) {
    MarkerStyle style = styleOf(collider, model, first_id);
    style.up = geometry.up;
    style.file = model.file;
    const std::vector<Marker> markers = surfaceMarkers(collider, style);
    if (markers.size() > 1 && told->insert(model.name).second) tellPieces(collider, model.name, markers.size());
    return markers;
  };
  addMarkers(geometry, sim::ModelKind::ENVIRONMENT, draw, &array);
  return array;
}

MarkerArray drawnObjects(const Geometry& geometry) {
  MarkerArray array = withoutOldOnes();
  const auto draw = [](const contact::Collider& collider, const sim::ModelInfo& model, int first_id) {
    return surfaceMarkers(collider, styleOf(collider, model, first_id));
  };
  addMarkers(geometry, sim::ModelKind::OBJECT, draw, &array);
  return array;
}

/** Layers of a robot's links go with the links' frames. */
MarkerStyle linkStyle(const sim::Simulator& simulator, const contact::Collider& collider, MarkerStyle style) {
  const auto& robots = simulator.robots();
  const auto robot = std::find_if(robots.begin(), robots.end(), [&](const sim::RobotInfo& info) { return info.model == collider.model; });
  if (robot == robots.end() || collider.link < 0) return style;
  const model::LinkPlacement& placement = robot->lumped->link_placement[collider.link];
  const bool fixed = collider.body == dynamics::WORLD_BODY;
  style.frame = ownFrame(*robot, robot->description->links[collider.link].name);
  style.X_FC = (fixed ? Pose(robot->X_WR * placement.X_BL) : placement.X_BL).inverse() * collider.X_BC;
  return style;
}

MarkerArray drawnLayers(const sim::Simulator& simulator) {
  const Geometry geometry = geometryOf(simulator);
  MarkerArray array = withoutOldOnes();
  const auto draw = [&](const contact::Collider& collider, const sim::ModelInfo& model, int first_id) {
    return layerMarkers(collider, linkStyle(simulator, collider, styleOf(collider, model, first_id)));
  };
  for (const sim::ModelKind kind : {sim::ModelKind::ENVIRONMENT, sim::ModelKind::ROBOT, sim::ModelKind::OBJECT})
    addMarkers(geometry, kind, draw, &array);
  return array;
}

}  // namespace

GeometryMarkerPublisher::GeometryMarkerPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator)
    : simulator_(simulator),
      environments_(private_node.advertise<MarkerArray>("environment_markers", 1, true)),
      objects_(private_node.advertise<MarkerArray>("object_markers", 1, true)) {
  if (simulator.config().layer_markers) layers_ = private_node.advertise<MarkerArray>("layer_markers", 1, true);
  modelsChanged();
}

void GeometryMarkerPublisher::modelsChanged() {
  thread_.drain();
  const Geometry geometry = geometryOf(simulator_);
  environments_.publish(drawnEnvironments(geometry, &told_));
  objects_.publish(drawnObjects(geometry));
  if (layers_) layers_.publish(drawnLayers(simulator_));
}

void GeometryMarkerPublisher::cloudsChanged() {
  if (environments_.getNumSubscribers() == 0) return;
  thread_.add([this, geometry = geometryOf(simulator_)] { environments_.publish(drawnEnvironments(geometry, &told_)); });
}

LoadReportPublisher::LoadReportPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator)
    : simulator_(simulator), publisher_(private_node.advertise<LoadReport>("load_report", 1, true)) {
  modelsChanged();
}

void LoadReportPublisher::modelsChanged() {
  LoadReport message;
  message.header.stamp = toStamp(simulator_.time());
  for (const geometry::MeshReport& report : simulator_.loadReport()) message.meshes.push_back(toEntry(report));
  message.notes = simulator_.notes();
  publisher_.publish(message);
}

}  // namespace blem_sim::node
