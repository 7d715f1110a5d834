#include "gazebo/gazebo_sensor_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "gazebo/gazebo_noise.h"

namespace blem_sim::sim {
namespace {

GazeboNoise readVector(GazeboReader* reader, const std::string& path) {
  return readAxes(reader, {path + "/x", path + "/y", path + "/z"}, path);
}

/** Noise of three axes, written axis by axis or, as formerly, for all at once. */
GazeboNoise readImuNoise(GazeboReader* reader, const std::string& axes, const std::string& formerly) {
  GazeboNoise noise = readVector(reader, "imu/" + axes);
  const GazeboNoise whole = readNoise(reader, "imu/noise/" + formerly, "imu/noise/type");
  return noise.stddev == 0 && noise.mean == 0 && noise.bias_mean == 0 && noise.bias_stddev == 0 ? whole : noise;
}

void readImuSensor(GazeboReader* reader, SensorConfig* sensor) {
  const GazeboNoise gyro = readImuNoise(reader, "angular_velocity", "rate");
  const GazeboNoise accel = readImuNoise(reader, "linear_acceleration", "accel");
  sensor->noise = {accel.quantity(), gyro.quantity()};
  reader->skip({"imu/topic"});
}

void readWrenchSensor(GazeboReader* reader, SensorConfig* sensor) {
  const auto choose = [&](const char* path, std::initializer_list<const char*> words, std::string* value) {
    const auto given = reader->text(path);
    if (!given) return;
    if (std::find(words.begin(), words.end(), *given) != words.end())
      *value = *given;
    else
      reader->fault(path,
                    fmt::format("'{}' is not known; it is left out: write one of {}", *given, fmt::join(words.begin(), words.end(), ", ")));
  };
  sensor->measure = "child_to_parent";
  choose("force_torque/frame", {"child", "parent", "sensor"}, &sensor->frame);
  choose("force_torque/measure_direction", {"child_to_parent", "parent_to_child"}, &sensor->measure);
  const GazeboNoise force = readVector(reader, "force_torque/force"), torque = readVector(reader, "force_torque/torque");
  sensor->noise = {force.quantity(), torque.quantity()};
}

void readTouchSensor(GazeboReader* reader, SensorConfig*) { reader->skip({"contact"}); }

void readRaySensor(GazeboReader* reader, SensorConfig* sensor) {
  RangeSensorConfig& rays = sensor->rays;
  rays.beams = 640;  // and the others: what Gazebo takes where nothing is given
  rays.first_angle = rays.last_angle = 0;
  rays.nearest = 0;
  rays.farthest = 30;
  double resolution[2] = {1, 1};
  reader->read("ray/scan/horizontal/samples", &rays.beams, NumberRange::positive());
  reader->read("ray/scan/horizontal/resolution", &resolution[0], NumberRange::positive());
  reader->read("ray/scan/horizontal/min_angle", &rays.first_angle, NumberRange::any());
  reader->read("ray/scan/horizontal/max_angle", &rays.last_angle, NumberRange::any());
  reader->read("ray/scan/vertical/samples", &rays.layers, NumberRange::positive());
  reader->read("ray/scan/vertical/resolution", &resolution[1], NumberRange::positive());
  reader->read("ray/scan/vertical/min_angle", &rays.lowest_angle, NumberRange::any());
  reader->read("ray/scan/vertical/max_angle", &rays.highest_angle, NumberRange::any());
  reader->read("ray/range/min", &rays.nearest, NumberRange::notNegative());
  reader->read("ray/range/max", &rays.farthest, NumberRange::positive());
  const auto rays_of = [](int samples, double factor) {
    return static_cast<int>(std::clamp(std::round(samples * factor), 1.0, static_cast<double>(std::numeric_limits<int>::max())));
  };
  rays.beams = rays_of(rays.beams, resolution[0]);
  rays.layers = rays_of(rays.layers, resolution[1]);
  if (rays.layers == 1) rays.lowest_angle = rays.highest_angle = 0;
  const GazeboNoise noise = readNoise(reader, "ray/noise", "ray/noise/type");
  rays.stddev = noise.stddev;
  if (noise.mean != 0) reader->fault("ray/noise/mean", "ranges have no bias here; it is left out: give 0");
  reader->skip({"ray/range/resolution"});
}

void readDepthSensor(GazeboReader* reader, SensorConfig* sensor) {
  RangeSensorConfig& rays = sensor->rays;
  rays.width = 320;  // and the others: what Gazebo takes where nothing is given
  rays.height = 240;
  rays.hfov = 1.047;
  rays.nearest = 0.1;
  rays.farthest = 100;
  reader->read("camera/horizontal_fov", &rays.hfov, NumberRange::positive());
  reader->read("camera/image/width", &rays.width, NumberRange::positive());
  reader->read("camera/image/height", &rays.height, NumberRange::positive());
  reader->read("camera/clip/near", &rays.nearest, NumberRange::notNegative());
  reader->read("camera/clip/far", &rays.farthest, NumberRange::positive());
  reader->skip({"camera/name", "camera/image/format", "camera/depth_camera"});
  reader->skipWithoutEffect({"camera/noise"});
}

constexpr double CAMERA_RATE = 30, LIDAR_RATE = 40;  // [Hz]

const GazeboSensorType SENSOR_TYPES[] = {
    {"imu", SensorType::IMU, 0, readImuSensor},
    {"force_torque", SensorType::FORCE_TORQUE, 0, readWrenchSensor},
    {"contact", SensorType::CONTACT, 0, readTouchSensor},
    {"ray", SensorType::LIDAR, LIDAR_RATE, readRaySensor},
    {"gpu_ray", SensorType::LIDAR, LIDAR_RATE, readRaySensor},
    {"depth", SensorType::DEPTH_CAMERA, CAMERA_RATE, readDepthSensor},
};

}  // namespace

const GazeboSensorType* gazeboSensorType(const std::string& name) {
  const auto found =
      std::find_if(std::begin(SENSOR_TYPES), std::end(SENSOR_TYPES), [&](const GazeboSensorType& row) { return row.name == name; });
  return found == std::end(SENSOR_TYPES) ? nullptr : found;
}

}  // namespace blem_sim::sim
