#include "clouds/surface_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "clouds/cloud_message.h"
#include "clouds/grid_message.h"
#include "clouds/mesh_message.h"
#include "messages/conversions.h"

namespace blem_sim::node {
namespace {

using Mesher = model::CloudOptions::Mesher;

model::CloudOptions withoutFilters(model::CloudOptions options) {
  options.filters.clear();
  return options;
}

void move(const Pose& X, std::vector<Vector3>* points) {
  for (Vector3& p : *points) p = X * p;
}

}  // namespace

SurfaceBuilder::SurfaceBuilder(const sim::EnvironmentConfig& config, const CloudFrames& frames, const std::atomic<double>& time)
    : config_(config), frames_(frames), time_(time), map_(config.live.map), surface_options_(withoutFilters(config.cloud)) {}

Pose SurfaceBuilder::poseOf(const std_msgs::Header& header) const {
  if (header.stamp.toSec() > time_ + MOST_AHEAD)
    throw InputError(
        fmt::format("header.stamp: {:.3f} s lies in the future of simulated time, {:.3f} s", header.stamp.toSec(), time_.load()));
  return frames_.poseOf(header.frame_id, config_.live.frame, header.stamp);
}

/** The message's points in the environment's frame, on their pixel grid where a mesher may want it. */
model::SensedCloud SurfaceBuilder::sensed(const sensor_msgs::PointCloud2& message) const {
  const bool on_grid = config_.cloud.as == model::CloudOptions::As::MESH && message.height > 1 && message.width > 1 &&
                       (config_.cloud.mesher == Mesher::AUTO || config_.cloud.mesher == Mesher::ORGANIZED) &&
                       config_.cloud.filters.empty() && config_.live.update == sim::LiveConfig::Update::REPLACE;
  model::SensedCloud cloud(pointsOf(message, on_grid));
  if (on_grid) {
    cloud.width = static_cast<int>(message.width);
    cloud.height = static_cast<int>(message.height);
  }
  const Pose X_FC = poseOf(message.header);
  move(X_FC, &cloud.points);
  cloud.viewpoint = X_FC.translation();
  return cloud;
}

BuiltCloud SurfaceBuilder::build(const sensor_msgs::PointCloud2& message) {
  model::SensedCloud cloud = sensed(message);
  BuiltCloud built;
  built.stamp = message.header.stamp;
  built.points_received =
      static_cast<std::size_t>(std::count_if(cloud.points.begin(), cloud.points.end(), [](const Vector3& p) { return p.allFinite(); }));
  std::vector<std::string> notes;
  cloud.points = model::filtered(std::move(cloud.points), config_.cloud.filters, "cloud", &notes);
  if (config_.live.update == sim::LiveConfig::Update::ACCUMULATE) {
    map_.add(cloud.points, message.header.stamp.isZero() ? time_.load() : message.header.stamp.toSec());
    cloud.points = map_.points();
  }
  if (cloud.points.empty()) throw InputError("filters and the map left no point");
  built.surface = sim::makeCloudSurface(std::move(cloud), surface_options_, config_.live.topic);
  built.surface.report.notes.insert(built.surface.report.notes.begin(), notes.begin(), notes.end());
  if (built.surface.isMesh()) return built;
  // The first cloud's radius stays: one that changed from cloud to cloud would lift and lower what stands there.
  surface_options_.auto_radius = false;
  surface_options_.point_radius = built.surface.radius;
  return built;
}

BuiltCloud SurfaceBuilder::build(const shape_msgs::Mesh& message) {
  geometry::TriangleMesh mesh = meshOf(message);
  move(frames_.poseOf(config_.live.frame, WORLD_FRAME, ros::Time(0)), &mesh.vertices);
  BuiltCloud built;
  built.points_received = message.vertices.size();
  built.surface = sim::makeMeshSurface(std::move(mesh), config_.live.topic);
  return built;
}

BuiltCloud SurfaceBuilder::build(const nav_msgs::OccupancyGrid& message) {
  geometry::TriangleMesh mesh = wallsOf(message, {config_.live.occupied, config_.live.wall_height});
  move(poseOf(message.header), &mesh.vertices);
  BuiltCloud built;
  built.stamp = message.header.stamp;
  built.points_received = message.data.size();
  if (!mesh.elements.empty()) built.surface = sim::makeMeshSurface(std::move(mesh), config_.live.topic);
  return built;
}

}  // namespace blem_sim::node
