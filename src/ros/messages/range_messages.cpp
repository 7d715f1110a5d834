#include "messages/range_messages.h"

#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <cmath>
#include <cstring>

#include "blem_sim/sim/range_view.h"

namespace blem_sim::node {

namespace {

constexpr double MOST_MILLIMETRES = 65535;

/** An image of that encoding; pixel(depth) has its number. */
template <typename Pixel, typename ToPixel>
sensor_msgs::Image imageOf(const sim::RangeSensorConfig& camera, const char* encoding, const std::vector<float>& depths, ToPixel&& pixel) {
  sensor_msgs::Image image;
  image.width = camera.width;
  image.height = camera.height;
  image.encoding = encoding;
  image.step = camera.width * sizeof(Pixel);
  image.data.resize(depths.size() * sizeof(Pixel));
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const Pixel value = pixel(depths[i]);
    std::memcpy(image.data.data() + i * sizeof value, &value, sizeof value);
  }
  return image;
}

/** A cloud of rows of points: point(row, column), anything not finite where there is none. */
template <typename Point>
sensor_msgs::PointCloud2 cloudOf(int rows, int columns, Point&& point) {
  sensor_msgs::PointCloud2 cloud;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2FieldsByString(1, "xyz");
  modifier.resize(static_cast<std::size_t>(rows) * columns);
  cloud.width = columns;
  cloud.height = rows;
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.is_dense = false;
  sensor_msgs::PointCloud2Iterator<float> x(cloud, "x");
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column, ++x) {
      const Vector3 p = point(row, column);
      for (int k = 0; k < 3; ++k) x[k] = p.allFinite() ? static_cast<float>(p[k]) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return cloud;
}

}  // namespace

sensor_msgs::Image toMetreImage(const sim::RangeSensorConfig& camera, const std::vector<float>& depths) {
  return imageOf<float>(camera, sensor_msgs::image_encodings::TYPE_32FC1.c_str(), depths, [](float depth) { return depth; });
}

sensor_msgs::Image toMillimetreImage(const sim::RangeSensorConfig& camera, const std::vector<float>& depths) {
  return imageOf<std::uint16_t>(camera, sensor_msgs::image_encodings::TYPE_16UC1.c_str(), depths, [](float depth) {
    const double millimetres = std::round(1000.0 * depth);
    return static_cast<std::uint16_t>(millimetres <= MOST_MILLIMETRES ? millimetres : 0);
  });
}

sensor_msgs::CameraInfo toCameraInfo(const sim::RangeSensorConfig& camera) {
  const auto [width, height, f, u, v] = sim::pinholeOf(camera);
  sensor_msgs::CameraInfo info;
  info.width = width;
  info.height = height;
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(5, 0);
  info.K = {f, 0, u, 0, f, v, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {f, 0, u, 0, 0, f, v, 0, 0, 0, 1, 0};
  return info;
}

sensor_msgs::PointCloud2 toCloud(const sim::RangeSensorConfig& camera, const std::vector<float>& depths) {
  const contact::Pinhole pinhole = sim::pinholeOf(camera);
  return cloudOf(camera.height, camera.width, [&](int row, int column) -> Vector3 {
    const double depth = depths[static_cast<std::size_t>(row) * camera.width + column];
    return depth * Vector3((column - pinhole.middle_u) / pinhole.focal_length, (row - pinhole.middle_v) / pinhole.focal_length, 1);
  });
}

sensor_msgs::LaserScan toScan(const sim::SensorConfig& lidar, const std::vector<float>& ranges) {
  const sim::RangeSensorConfig& rays = lidar.rays;
  sensor_msgs::LaserScan scan;
  scan.angle_min = rays.first_angle;
  scan.angle_max = sim::beamAngle(rays, rays.beams - 1);
  scan.angle_increment = rays.beams > 1 ? (rays.last_angle - rays.first_angle) / (rays.beams - 1) : 0;
  scan.scan_time = lidar.rate > 0 ? 1 / lidar.rate : 0;
  scan.range_min = rays.nearest;
  scan.range_max = rays.farthest;
  scan.ranges = ranges;
  return scan;
}

sensor_msgs::PointCloud2 toLayeredCloud(const sim::RangeSensorConfig& lidar, const std::vector<float>& ranges) {
  return cloudOf(lidar.layers, lidar.beams, [&](int layer, int beam) -> Vector3 {
    return ranges[static_cast<std::size_t>(layer) * lidar.beams + beam] * sim::beamDirection(lidar, layer, beam);
  });
}

}  // namespace blem_sim::node
