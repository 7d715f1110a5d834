#include "publishers/markers/geometry_publishers.h"

#include <blem_sim/LoadReport.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>

#include "blem_sim/sim/drawing.h"
#include "messages/conversions.h"
#include "publishers/markers/surface_markers.h"

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

/** All environments, or all objects. They are sent anew, so that nothing unloaded stays in sight. @param up unit, for colours of clouds */
MarkerArray drawing(sim::ModelKind kind, const std::vector<contact::Collider>& colliders, const std::vector<sim::ModelInfo>& models,
                    const Vector3& up) {
  MarkerArray array;
  array.markers.emplace_back();
  array.markers.back().action = Marker::DELETEALL;
  array.markers.back().header.frame_id = WORLD_FRAME;
  std::map<std::string, int> next_id;  // by collider name: an object of several shapes has several colliders of that name
  for (const contact::Collider& collider : colliders) {
    if (!collider.enabled || collider.model < 0) continue;
    const sim::ModelInfo& model = models[collider.model];
    if (!model.alive || model.kind != kind) continue;
    const bool stands = kind == sim::ModelKind::ENVIRONMENT;
    int& id = next_id[collider.name];
    MarkerStyle style{stands ? WORLD_FRAME : model.name, collider.X_BC, toColour(sim::modelColour(kind, collider.model)), id};
    if (stands) style.up = up;
    for (Marker& marker : surfaceMarkers(collider, style)) {
      id = marker.id + 1;
      array.markers.push_back(std::move(marker));
    }
  }
  return array;
}

}  // namespace

GeometryMarkerPublisher::GeometryMarkerPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator)
    : simulator_(simulator),
      environments_(private_node.advertise<MarkerArray>("environment_markers", 1, true)),
      objects_(private_node.advertise<MarkerArray>("object_markers", 1, true)) {
  modelsChanged();
}

void GeometryMarkerPublisher::modelsChanged() {
  thread_.drain();
  const Vector3 up = sim::upwards(simulator_.gravity());
  environments_.publish(drawing(sim::ModelKind::ENVIRONMENT, simulator_.colliders(), simulator_.models(), up));
  objects_.publish(drawing(sim::ModelKind::OBJECT, simulator_.colliders(), simulator_.models(), up));
}

void GeometryMarkerPublisher::cloudsChanged() {
  if (environments_.getNumSubscribers() == 0) return;
  thread_.add([this, colliders = simulator_.colliders(), models = simulator_.models(), up = sim::upwards(simulator_.gravity())] {
    environments_.publish(drawing(sim::ModelKind::ENVIRONMENT, colliders, models, up));
  });
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
