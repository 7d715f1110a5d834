#include "gazebo/gazebo_plugin_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace blem_sim::sim {
namespace {

double together(double first_stddev, double second_stddev) { return std::hypot(first_stddev, second_stddev); }

/** The slower of two rates [Hz]; 0 is as fast as possible. */
void slowDown(double rate, SensorConfig* sensor) {
  if (rate > 0) sensor->rate = sensor->rate > 0 ? std::min(sensor->rate, rate) : rate;
}

void readCommon(GazeboReader* reader, GazeboSensor* sensor) {
  double rate = 0;
  reader->read("robotNamespace", &sensor->name_space);
  reader->read("topicName", &sensor->config.topic);
  reader->read("frameName", &sensor->config.frame_id);
  reader->read("frameId", &sensor->config.frame_id);
  reader->read("updateRate", &rate, NumberRange::notNegative());
  slowDown(rate, &sensor->config);
  reader->skip({"alwaysOn", "always_on"});
}

double gaussianNoise(GazeboReader* reader) {
  double stddev = 0;
  reader->read("gaussianNoise", &stddev, NumberRange::deviation());
  return stddev;
}

/** The plugin in a <sensor>, which knows its link. */
void readImuSensorPlugin(GazeboReader* reader, GazeboSensor* sensor) {
  SensorConfig& config = sensor->config;
  readCommon(reader, sensor);
  double rate = 0;
  reader->read("updateRateHZ", &rate, NumberRange::notNegative());
  slowDown(rate, &config);
  Vector3 xyz = Vector3::Zero(), rpy = Vector3::Zero();
  reader->read("xyzOffset", &xyz);
  reader->read("rpyOffset", &rpy);
  config.X_LS = config.X_LS * makePose(xyz, rpy);
  const double stddev = gaussianNoise(reader);
  config.noise[0].stddev = together(config.noise[0].stddev, stddev);
  config.noise[1].stddev = together(config.noise[1].stddev, stddev);
  std::optional<bool> first_is_zero;
  reader->read("initialOrientationAsReference", &first_is_zero);
  if (first_is_zero.value_or(false))
    reader->fault("initialOrientationAsReference", "the orientation is that in the world (REP 145); it is left out: write false");
  reader->skip({"bodyName"});
  reader->skipWithoutEffect({"serviceName"});
}

void readImuPlugin(GazeboReader* reader, GazeboSensor* sensor) {
  reader->read("bodyName", &sensor->config.link);
  readImuSensorPlugin(reader, sensor);
}

void readForceTorquePlugin(GazeboReader* reader, GazeboSensor* sensor) {
  readCommon(reader, sensor);
  reader->read("jointName", &sensor->config.joint);
  sensor->config.frame = "child";
  sensor->config.measure = "child_to_parent";
  const double stddev = gaussianNoise(reader);
  for (QuantityNoise& noise : sensor->config.noise) noise.stddev = together(noise.stddev, stddev);
}

void readBumper(GazeboReader* reader, GazeboSensor* sensor) {
  readCommon(reader, sensor);
  reader->read("bumperTopicName", &sensor->config.topic);
  const std::string frame = sensor->config.frame_id;
  if (!frame.empty() && frame != "world" && frame != "/world" && frame != "map" && frame != "/map")
    reader->fault("frameName", fmt::format("contacts are told in the world, not in '{}'; it is left out: write world", frame));
  sensor->config.frame_id.clear();
}

void readP3d(GazeboReader* reader, GazeboSensor* sensor) {
  SensorConfig& config = sensor->config;
  readCommon(reader, sensor);
  reader->read("bodyName", &config.link);
  config.twist = "world";
  config.noise[0].stddev = gaussianNoise(reader);
  Vector3 xyz = Vector3::Zero(), rpy = Vector3::Zero();
  for (const char* path : {"xyzOffset", "xyzOffsets"}) reader->read(path, &xyz);
  for (const char* path : {"rpyOffset", "rpyOffsets"}) reader->read(path, &rpy);
  config.X_offset = makePose(xyz, rpy);
}

void readLidarPlugin(GazeboReader* reader, GazeboSensor* sensor) {
  RangeSensorConfig& rays = sensor->config.rays;
  readCommon(reader, sensor);
  rays.stddev = together(rays.stddev, gaussianNoise(reader));
  reader->read("min_range", &rays.nearest, NumberRange::notNegative());
  reader->read("max_range", &rays.farthest, NumberRange::positive());
  reader->skipZeros({"hokuyoMinIntensity", "min_intensity"});
}

void readCameraPlugin(GazeboReader* reader, GazeboSensor* sensor) {
  SensorConfig& config = sensor->config;
  readCommon(reader, sensor);
  config.topic = config.name;
  reader->read("cameraName", &config.topic);
  config.topic.erase(0, std::min(config.topic.find_first_not_of('/'), config.topic.size()));  // never absolute in Gazebo
  if (config.topic.empty()) config.topic = config.name;
  const auto below = [&](const char* path, std::string* topic) {
    const std::string given = reader->text(path).value_or("");
    if (!given.empty()) *topic = given.front() == '/' ? given : config.topic + "/" + given;
  };
  below("depthImageTopicName", &config.camera_topics.image_raw);
  below("depthImageInfoTopicName", &config.camera_topics.camera_info);
  below("depthImageCameraInfoTopicName", &config.camera_topics.camera_info);
  below("pointCloudTopicName", &config.camera_topics.points);
  double nearest = 0, farthest = std::numeric_limits<double>::max();
  reader->read("pointCloudCutoff", &nearest, NumberRange::notNegative());
  reader->read("pointCloudCutoffMax", &farthest, NumberRange::positive());
  config.rays.nearest = std::max(config.rays.nearest, nearest);
  config.rays.farthest = std::min(config.rays.farthest, farthest);
  reader->skipWithoutEffect({"imageTopicName", "cameraInfoTopicName"});
  reader->skip({"baseline", "CxPrime", "CyPrime", "Cx", "Cy", "Fx", "Fy", "focalLength", "rangeMax", "useDepth16UC1"});
  reader->skipZeros({"hackBaseline", "distortionK1", "distortionK2", "distortionK3", "distortionT1", "distortionT2", "distortion_k1",
                     "distortion_k2", "distortion_k3", "distortion_t1", "distortion_t2"});
}

const GazeboPluginType PLUGIN_TYPES[] = {
    {"gazebo_ros_imu", SensorType::IMU, false, readImuPlugin},
    {"gazebo_ros_imu_sensor", SensorType::IMU, true, readImuSensorPlugin},
    {"gazebo_ros_ft_sensor", SensorType::FORCE_TORQUE, false, readForceTorquePlugin},
    {"gazebo_ros_bumper", SensorType::CONTACT, true, readBumper},
    {"gazebo_ros_p3d", SensorType::ODOMETRY, false, readP3d},
    {"gazebo_ros_laser", SensorType::LIDAR, true, readLidarPlugin},
    {"gazebo_ros_gpu_laser", SensorType::LIDAR, true, readLidarPlugin},
    {"gazebo_ros_block_laser", SensorType::LIDAR, true, readLidarPlugin},
    {"gazebo_ros_velodyne_laser", SensorType::LIDAR, true, readLidarPlugin},
    {"gazebo_ros_velodyne_gpu_laser", SensorType::LIDAR, true, readLidarPlugin},
    {"gazebo_ros_openni_kinect", SensorType::DEPTH_CAMERA, true, readCameraPlugin},
    {"gazebo_ros_depth_camera", SensorType::DEPTH_CAMERA, true, readCameraPlugin},
};

}  // namespace

std::string pluginName(const std::string& filename) {
  const std::string start = "lib", end = ".so";
  std::string name = filename;
  if (name.compare(0, start.size(), start) == 0) name.erase(0, start.size());
  if (name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0) name.erase(name.size() - end.size());
  return name;
}

const GazeboPluginType* gazeboPluginType(const std::string& filename) {
  const std::string name = pluginName(filename);
  const auto found =
      std::find_if(std::begin(PLUGIN_TYPES), std::end(PLUGIN_TYPES), [&](const GazeboPluginType& row) { return row.name == name; });
  return found == std::end(PLUGIN_TYPES) ? nullptr : found;
}

}  // namespace blem_sim::sim
