#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "config/config_sections.h"
#include "config/range_sensor_check.h"

namespace blem_sim::sim {

namespace {

using ReadSensor = void (*)(YamlReader&, SensorConfig*);

void requireText(YamlReader& reader, const std::string& key, std::string* value) {
  reader.read(key, value);
  if (value->empty()) reader.refuse(key, "is missing; name the " + key + " that the sensor sits on");
}

constexpr double LONGEST_DELAY = 1;  // [s]

/** Names of the quantities that a sensor measures, in the order of its limits and noise. */
using Quantities = std::vector<std::string>;

void readDelay(YamlReader& reader, SensorConfig* sensor) {
  reader.read("delay", &sensor->delay, {0, LONGEST_DELAY, false, "a number from 0 to 1 s"});
}

void readLimits(YamlReader& reader, const Quantities& quantities, SensorConfig* sensor) {
  YamlReader saturation = reader.section("saturation"), resolution = reader.section("resolution");
  QuantityLimits* limits = sensor->limits.data();
  for (const std::string& quantity : quantities) {
    saturation.read(quantity, &limits->saturation, NumberRange::positiveOrInfinite());
    resolution.read(quantity, &limits->resolution, NumberRange::notNegative());
    if (limits->resolution > limits->saturation) resolution.refuse(quantity, "is coarser than its saturation; give a smaller step");
    ++limits;
  }
  saturation.finish();
  resolution.finish();
}

void readNoise(YamlReader& reader, const Quantities& quantities, SensorConfig* sensor) {
  YamlReader noise = reader.section("noise");
  if (sensor->type == SensorType::FORCE_TORQUE) {
    noise.read("stddev", &sensor->noise[0].stddev, NumberRange::deviation());  // of both
    sensor->noise[1] = sensor->noise[0];
  }
  QuantityNoise* of = sensor->noise.data();
  for (const std::string& quantity : quantities) {
    noise.read(quantity + "_stddev", &of->stddev, NumberRange::deviation());
    noise.read(quantity + "_bias_stddev", &of->bias_stddev, NumberRange::deviation());
    noise.read(quantity + "_bias", &of->bias, NumberRange::bias());
    noise.read(quantity + "_bias_spread", &of->bias_spread, NumberRange::deviation());
    ++of;
  }
  noise.finish();
}

/** Delay, noise, range and resolution. */
void readErrors(YamlReader& reader, const Quantities& quantities, SensorConfig* sensor) {
  readDelay(reader, sensor);
  readNoise(reader, quantities, sensor);
  readLimits(reader, quantities, sensor);
}

void readForceTorque(YamlReader& reader, SensorConfig* sensor) {
  const std::vector<std::string> senses = {"parent_to_child", "child_to_parent"};
  requireText(reader, "joint", &sensor->joint);
  reader.read("frame", &sensor->frame);
  reader.read("frame_id", &sensor->frame_id);
  if (const auto sense = reader.choice("measure", senses)) sensor->measure = senses[*sense];
  readErrors(reader, {"force", "torque"}, sensor);
}

/** The link that a sensor sits on, its pose there, and its messages' frame. */
void readMounting(YamlReader& reader, SensorConfig* sensor) {
  requireText(reader, "link", &sensor->link);
  reader.read("pose", &sensor->X_LS);
  reader.read("frame_id", &sensor->frame_id);
}

void readTilt(YamlReader& reader, SensorConfig* sensor) {
  readMounting(reader, sensor);
  readErrors(reader, {"angle", "gyro"}, sensor);
}

void readImu(YamlReader& reader, SensorConfig* sensor) {
  readMounting(reader, sensor);
  readErrors(reader, {"accel", "gyro"}, sensor);
}

void readContactSensor(YamlReader& reader, SensorConfig* sensor) { requireText(reader, "link", &sensor->link); }

void readContactSwitch(YamlReader& reader, SensorConfig* sensor) {
  requireText(reader, "link", &sensor->link);
  reader.read("threshold", &sensor->threshold, NumberRange::notNegative());
  readDelay(reader, sensor);
  readNoise(reader, {"force"}, sensor);
}

void readCentreOfPressure(YamlReader& reader, SensorConfig* sensor) {
  readMounting(reader, sensor);
  reader.read("threshold", &sensor->threshold, NumberRange::notNegative());
  readErrors(reader, {"position"}, sensor);
}

void readOdometry(YamlReader& reader, SensorConfig* sensor) {
  readMounting(reader, sensor);
  const std::vector<std::string> axes = {"link", "world"};
  if (const auto twist = reader.choice("twist", axes)) sensor->twist = axes[*twist];
  reader.read("offset", &sensor->X_offset);
  YamlReader noise = reader.section("noise");
  noise.read("stddev", &sensor->noise[0].stddev, NumberRange::deviation());
  noise.finish();
}

void readMotorCurrent(YamlReader& reader, SensorConfig* sensor) {
  readErrors(reader, {"current", "effort"}, sensor);
  reader.forEachName("torque_constant", [&](const std::string& joint, YamlReader& map) {
    map.read(joint, &sensor->torque_constant[joint], NumberRange::positive());
  });
}

// Lower bound of counts: refuseFaults says why one cannot be used.
constexpr int ANY_COUNT = std::numeric_limits<int>::min();

void readRays(YamlReader& reader, SensorConfig* sensor) {
  readMounting(reader, sensor);
  if (const auto range = reader.numbers("range", 2)) {
    sensor->rays.nearest = (*range)[0];
    sensor->rays.farthest = (*range)[1];
  }
}

void refuseFaults(const YamlReader& reader, const SensorConfig& sensor) {
  if (const auto fault = faultOf(sensor.type, sensor.rays)) reader.refuse(fault->key, fault->why);
}

void readDepthCamera(YamlReader& reader, SensorConfig* sensor) {
  RangeSensorConfig& rays = sensor->rays;
  readRays(reader, sensor);
  reader.read("width", &rays.width, ANY_COUNT);
  reader.read("height", &rays.height, ANY_COUNT);
  reader.read("hfov", &rays.hfov, NumberRange::any());
  YamlReader topics = reader.section("topics");
  topics.read("image_raw", &sensor->camera_topics.image_raw);
  topics.read("image", &sensor->camera_topics.image);
  topics.read("camera_info", &sensor->camera_topics.camera_info);
  topics.read("points", &sensor->camera_topics.points);
  topics.finish();
  YamlReader noise = reader.section("noise");
  if (const auto model = noise.choice("model", {"gaussian", "kinect"})) rays.noise = *model ? RangeNoise::KINECT : RangeNoise::GAUSSIAN;
  noise.read("stddev", &rays.stddev, NumberRange::deviation());
  noise.finish();
  refuseFaults(reader, *sensor);
}

void readLidar(YamlReader& reader, SensorConfig* sensor) {
  RangeSensorConfig& rays = sensor->rays;
  rays.nearest = 0.1;
  rays.farthest = 30;
  readRays(reader, sensor);
  reader.read("beams", &rays.beams, ANY_COUNT);
  reader.read("layers", &rays.layers, ANY_COUNT);
  if (const auto angle = reader.numbers("angle", 2)) {
    rays.first_angle = (*angle)[0];
    rays.last_angle = (*angle)[1];
  }
  if (const auto angle = reader.numbers("vertical_angle", 2)) {
    rays.lowest_angle = (*angle)[0];
    rays.highest_angle = (*angle)[1];
  }
  YamlReader noise = reader.section("noise");
  noise.read("stddev", &rays.stddev, NumberRange::deviation());
  noise.finish();
  refuseFaults(reader, *sensor);
}

/** A new sensor is one row: its name in the YAML, its type, its rate [Hz] unless told otherwise, its own keys. */
struct SensorRow {
  const char* name;
  SensorType type;
  double rate;
  ReadSensor read;
};
const std::vector<SensorRow> SENSOR_TABLE = {
    {"force_torque", SensorType::FORCE_TORQUE, 0, readForceTorque},
    {"imu", SensorType::IMU, 0, readImu},
    {"contact", SensorType::CONTACT, 0, readContactSensor},
    {"contact_switch", SensorType::CONTACT_SWITCH, 0, readContactSwitch},
    {"centre_of_pressure", SensorType::CENTRE_OF_PRESSURE, 0, readCentreOfPressure},
    {"tilt", SensorType::TILT, 0, readTilt},
    {"motor_current", SensorType::MOTOR_CURRENT, 0, readMotorCurrent},
    {"odometry", SensorType::ODOMETRY, 50, readOdometry},
    {"depth_camera", SensorType::DEPTH_CAMERA, 30, readDepthCamera},
    {"lidar", SensorType::LIDAR, 40, readLidar},
};

SensorConfig readSensor(YamlReader& reader) {
  SensorConfig sensor;
  sensor.name = readName(reader);
  std::vector<std::string> types;
  for (const SensorRow& row : SENSOR_TABLE) types.push_back(row.name);
  const auto type = reader.choice("type", types);
  if (!type) reader.refuse("type", fmt::format("is missing; one of {}", fmt::join(types, ", ")));
  sensor.type = SENSOR_TABLE[*type].type;
  sensor.rate = SENSOR_TABLE[*type].rate;
  reader.read("topic", &sensor.topic);
  reader.readRate("rate", &sensor.rate);
  SENSOR_TABLE[*type].read(reader, &sensor);
  return sensor;
}

}  // namespace

std::vector<SensorConfig> readSensors(YamlReader& robot) {
  std::vector<SensorConfig> sensors;
  robot.forEachItem("sensors", [&](YamlReader& reader) {
    SensorConfig sensor = readSensor(reader);
    const auto same = [&](const SensorConfig& other) { return other.name == sensor.name; };
    if (std::any_of(sensors.begin(), sensors.end(), same)) reader.refuse("name", "'" + sensor.name + "' is taken by another sensor");
    sensors.push_back(std::move(sensor));
  });
  return sensors;
}

}  // namespace blem_sim::sim
