#include "gazebo/gazebo_sensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "blem_sim/sim/sensor_values.h"
#include "config/range_sensor_check.h"
#include "gazebo/gazebo_drives.h"
#include "gazebo/gazebo_names.h"
#include "gazebo/gazebo_sensor_types.h"

namespace blem_sim::sim {
namespace {

constexpr std::size_t MOST_SENSORS = 1000;  // of a robot
constexpr const char* WORLD = "world";
constexpr const char* PREFIX = "sensor_";  // of names that begin with no letter
// Topics of every robot, which no sensor may have.
const char* const TAKEN_TOPICS[] = {"joint_states", "odom", "joint_command", "joint_trajectory"};

const char* wordOf(SensorType type) {
  switch (type) {
    case SensorType::FORCE_TORQUE:
      return "force_torque";
    case SensorType::IMU:
      return "imu";
    case SensorType::CONTACT:
      return "contact";
    case SensorType::ODOMETRY:
      return "odometry";
    case SensorType::LIDAR:
      return "lidar";
    case SensorType::DEPTH_CAMERA:
      return "depth_camera";
    default:
      return "sensor";
  }
}

/** A plugin that has a joint follow another; here <mimic> does. */
bool isMimicPlugin(const std::string& name) { return name.find("mimic_joint") != std::string::npos; }

/** Notes a joint that follows in Gazebo alone. */
void readMimicPlugin(GazeboReader* reader, const model::RobotModel& model) {
  model::Mimic asked;
  std::string follower;
  reader->read("joint", &asked.joint);
  reader->read("mimicJoint", &follower);
  reader->read("multiplier", &asked.multiplier, NumberRange::any());
  reader->read("offset", &asked.offset, NumberRange::any());
  reader->skip({"robotNamespace"});
  reader->skipWithoutEffect({"maxEffort", "sensitiveness", "hasPID"});
  const int joint = model.jointIndex(follower);
  if (joint < 0) return reader->fault("mimicJoint", unknownName("joint", follower, model.joints) + "; it is left out: correct it");
  const std::optional<model::Mimic>& mimic = model.joints[joint].mimic;
  if (mimic && mimic->joint == asked.joint && mimic->multiplier == asked.multiplier && mimic->offset == asked.offset) return;
  reader->fault("mimicJoint", fmt::format("'{}' follows as its <mimic> says, and it has {}: write <mimic joint=\"{}\" multiplier=\"{:g}\" "
                                          "offset=\"{:g}\"/> into it",
                                          follower, mimic ? "another one" : "none", asked.joint, asked.multiplier, asked.offset));
}

}  // namespace

void GazeboSensors::read(const model::GazeboBlock& gazebo) {
  for (const model::GazeboBlock& block : gazebo.blocks) {
    if (block.element == "sensor")
      readSensor(block);
    else
      readPlugin(block);
  }
}

void GazeboSensors::readSensor(const model::GazeboBlock& block) {
  const GazeboSensorType* type = gazeboSensorType(block.type);
  GazeboReader reader(block, &notes_);
  if (!type) return notes_.unknown(reader.where(), fmt::format("of type '{}'", block.type));
  GazeboSensor sensor;
  SensorConfig& config = sensor.config;
  config.type = type->type;
  config.name = block.name;
  (config.type == SensorType::FORCE_TORQUE ? config.joint : config.link) = block.reference;
  type->read(&reader, &config);
  reader.read("update_rate", &config.rate, NumberRange::notNegative());
  reader.read("pose", &config.X_LS);
  if (config.type == SensorType::FORCE_TORQUE && !config.X_LS.isApprox(Pose::Identity()))
    reader.fault("pose", "the sensor sits at the joint; it is left out: take it away");
  reader.skip({"always_on", "visualize", "topic", "pose/frame"});
  reader.finish();
  bool has_plugin = false;
  for (const model::GazeboBlock& inner : block.blocks) {
    const GazeboPluginType* plugin = inner.element == "plugin" ? gazeboPluginType(inner.type) : nullptr;
    GazeboReader plugin_reader(inner, &notes_);
    if (!plugin || plugin->type != config.type) {
      notes_.unknown(plugin_reader.where(), fmt::format("of type '{}' in {}", inner.type, reader.where()));
      continue;
    }
    plugin->read(&plugin_reader, &sensor);
    plugin_reader.finish();
    has_plugin = true;
  }
  if (config.rate == 0) config.rate = type->rate;
  if (has_plugin)
    add(std::move(sensor), block);
  else
    plain_.push_back({std::move(sensor), &block});
}

void GazeboSensors::finish() {
  for (auto& [sensor, block] : plain_) add(std::move(sensor), *block);
  plain_.clear();
}

void GazeboSensors::readPlugin(const model::GazeboBlock& block) {
  const GazeboPluginType* type = gazeboPluginType(block.type);
  if (!type && readGazeboDrive(block, model_, &notes_, &config_)) return;
  if (!type) return readOtherPlugin(block);
  GazeboReader reader(block, &notes_);
  if (type->inside)
    return notes_.fault(reader.where(), fmt::format("'{}' stands outside of a <sensor>; it is left out: put it into one", block.type));
  GazeboSensor sensor;
  sensor.config.type = type->type;
  sensor.config.name = block.name;
  (type->type == SensorType::FORCE_TORQUE ? sensor.config.joint : sensor.config.link) = block.reference;
  type->read(&reader, &sensor);
  reader.finish();
  add(std::move(sensor), block);
}

void GazeboSensors::readOtherPlugin(const model::GazeboBlock& block) {
  const std::string name = pluginName(block.type);
  GazeboReader reader(block, &notes_);
  if (name == "gazebo_ros_control") {
    const std::string name_space = reader.text("robotNamespace").value_or("");
    if (!name_space.empty() && resolved("") != withoutDoubleSlashes("/" + name_space + "/"))
      reader.fault("robotNamespace", fmt::format("'{}' is not where the robot's topics are; it is left out: set namespace", name_space));
    reader.skip({"robotSimType", "robotParam", "legacyModeNS"});
    reader.skipWithoutEffect({"controlPeriod"});
  } else if (name == "gazebo_ros_joint_state_publisher") {
    reader.skip({"robotNamespace", "alwaysOn"});
    reader.skipWithoutEffect({"jointName", "updateRate"});
  } else if (isMimicPlugin(name)) {
    readMimicPlugin(&reader, model_);
  } else {
    return notes_.unknown(reader.where(), fmt::format("of type '{}'", block.type));
  }
  reader.finish();
}

const SensorConfig* GazeboSensors::sensorNamed(const std::string& name) const {
  const auto named = [&](const SensorConfig& sensor) { return sensor.name == name; };
  const auto found = std::find_if(config_.sensors.begin(), config_.sensors.end(), named);
  return found == config_.sensors.end() ? nullptr : &*found;
}

std::string GazeboSensors::resolved(const std::string& topic) const { return resolvedTopic(config_.name_space, topic); }

void GazeboSensors::add(GazeboSensor sensor, const model::GazeboBlock& block) {
  const GazeboReader reader(block, &notes_);
  SensorConfig& config = sensor.config;
  if (config_.sensors.size() >= configured_ + MOST_SENSORS)
    return notes_.fault(reader.where(), fmt::format("is one of more than {} sensors; it is left out: give fewer", MOST_SENSORS));
  const std::string seat = config.type == SensorType::FORCE_TORQUE ? config.joint : config.link;
  config.name = rosWord(config.name.empty() ? fmt::format("{}_{}", seat, wordOf(config.type)) : config.name, PREFIX);
  const SensorConfig* same = sensorNamed(config.name);
  if (same && same < config_.sensors.data() + configured_) return;
  if (same) config.name += "_" + rosWord(seat, PREFIX);
  nameTopics(&sensor);
  nameFrame(reader, &config);
  if (!sitsSomewhere(config, reader) || !topicIsFree(reader, &config)) return;
  if (const auto fault = faultOf(config.type, config.rays))
    return notes_.fault(reader.where(), fmt::format("its {} {}; it is left out", fault->key, fault->why));
  if (sensorNamed(config.name)) return notes_.fault(reader.where(), "is there twice; it is left out: rename it");
  notes_.sensor(fmt::format("{} ({} of '{}' on {})", config.name, wordOf(config.type), seat, resolved(sensorTopic(config))));
  config_.sensors.push_back(config);
}

void GazeboSensors::nameTopics(GazeboSensor* sensor) {
  SensorConfig& config = sensor->config;
  if (config.topic.empty() && !sensor->name_space.empty()) config.topic = config.name;
  for (std::string* topic :
       {&config.topic, &config.camera_topics.image_raw, &config.camera_topics.camera_info, &config.camera_topics.points}) {
    *topic = topicInBlock(*topic, sensor->name_space, config_.name_space);
    if (topic->empty() || isTopic(*topic)) continue;
    notes_.fault(fmt::format("sensor '{}'", config.name),
                 fmt::format("'{}' is no ROS topic; it is left out: use letters, digits, _ and /", *topic));
    topic->clear();
  }
}

void GazeboSensors::nameFrame(const GazeboReader& reader, SensorConfig* sensor) {
  std::string& frame = sensor->frame_id;
  frame.erase(0, std::min(frame.find_first_not_of('/'), frame.size()));
  if (sensor->type != SensorType::ODOMETRY || frame == WORLD || model_.linkIndex(frame) < 0) return;
  notes_.fault(reader.where(), fmt::format("poses are those in the world, not in link '{}'; frameName is left out: write world", frame));
  frame.clear();
}

bool GazeboSensors::sitsSomewhere(const SensorConfig& sensor, const GazeboReader& reader) const {
  std::string why;
  if (sensor.type != SensorType::FORCE_TORQUE) {
    if (model_.linkIndex(sensor.link) < 0) why = unknownName("link", sensor.link, model_.links);
  } else if (const int joint = model_.jointIndex(sensor.joint); joint < 0) {
    why = unknownName("joint", sensor.joint, model_.joints);
  } else if (const model::JointType type = model_.joints[joint].type;
             type == model::JointType::FLOATING || type == model::JointType::PLANAR) {
    why = fmt::format("joint '{}' is floating or planar and carries no wrench", sensor.joint);
  }
  if (!why.empty()) notes_.fault(reader.where(), why + "; it is left out: name another");
  return why.empty();
}

bool GazeboSensors::topicIsFree(const GazeboReader& reader, SensorConfig* sensor) const {
  const auto is = [&](const std::string& topic) { return resolved(sensorTopic(*sensor)) == resolved(topic); };
  for (const char* taken : TAKEN_TOPICS) {
    if (!is(taken)) continue;
    notes_.fault(reader.where(), fmt::format("its topic {} is the robot's own; it is on {}: give it another", taken, sensor->name));
    sensor->topic.clear();
  }
  for (const SensorConfig& other : config_.sensors) {
    if (!is(sensorTopic(other))) continue;
    const bool configured = &other < config_.sensors.data() + configured_;
    if (!configured)
      notes_.fault(reader.where(),
                   fmt::format("sensor '{}' has its topic {}; it is left out: give it another", other.name, sensorTopic(other)));
    return false;
  }
  return true;
}

}  // namespace blem_sim::sim
