#include "publishers/sensor_publisher.h"

#include <tf2_msgs/TFMessage.h>
#include <boost/make_shared.hpp>

#include <optional>
#include <set>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/sensor_values.h"
#include "messages/contact_messages.h"
#include "messages/conversions.h"
#include "messages/ros_names.h"
#include "publishers/robot_topics.h"

namespace blem_sim::node {

namespace {

// Sensors run at every step by default; a subscriber may be a moment late.
constexpr int SENSOR_QUEUE = 1000;

template <typename Covariance>
void setVariance(Covariance* covariance, double stddev) {
  for (const int diagonal : {0, 4, 8}) (*covariance)[diagonal] = stddev * stddev;
}

/** One conversion and one publication per kind of reading; does not compile until a new kind has its own. */
struct ReadingPublisher {
  const sim::Simulator& simulator;
  const sim::StepReport& report;
  const std::string& frame_id;
  const std::string& child_frame_id;  // of odometry
  SensorMessages* messages;
  ListenedPublisher* publisher;                      // none for cameras and lidars
  const std::shared_ptr<const RangeTopics>& topics;  // for them alone
  RangePublisher* ranges;
  StepSender* sender;

  template <typename Message>
  boost::shared_ptr<Message> startedFrom(MessagePool<Message>* pool) const {
    const boost::shared_ptr<Message> message = pool->spare();
    message->header.stamp = toStamp(report.time);
    message->header.frame_id = frame_id;
    return message;
  }

  void operator()(const sim::ForceTorqueReading& reading) const {
    const auto message = startedFrom(&messages->wrenches);
    message->wrench = toWrench(reading.force, reading.torque);
    sender->add(publisher, message);
  }

  void operator()(const sim::ImuReading& reading) const {
    const auto message = startedFrom(&messages->imus);
    message->orientation = toQuaternion(reading.orientation);
    message->angular_velocity = toVector3(reading.angular_velocity);
    message->linear_acceleration = toVector3(reading.linear_acceleration);
    setVariance(&message->angular_velocity_covariance, reading.gyro_stddev);
    setVariance(&message->linear_acceleration_covariance, reading.accel_stddev);
    sender->add(publisher, message);
  }

  void operator()(const sim::ContactReading& reading) const {
    sender->add(publisher, boost::make_shared<ContactsState>(toContactsState(simulator, report, reading)));
  }

  void operator()(const sim::ContactSwitchReading& reading) const {
    const auto message = messages->switches.spare();
    message->data = reading.closed;
    sender->add(publisher, message);
  }

  void operator()(const sim::CentreOfPressureReading& reading) const {
    const auto message = startedFrom(&messages->points);
    message->point = toPoint({reading.x, reading.y, 0});
    sender->add(publisher, message);
  }

  void operator()(const sim::TiltReading& reading) const {
    const auto message = startedFrom(&messages->imus);
    message->orientation = toQuaternion(reading.orientation);
    message->angular_velocity = toVector3(reading.angular_velocity);
    setVariance(&message->orientation_covariance, reading.angle_stddev);
    setVariance(&message->angular_velocity_covariance, reading.gyro_stddev);
    message->linear_acceleration_covariance[0] = -1;  // sensor_msgs: not measured
    sender->add(publisher, message);
  }

  void operator()(const sim::MotorCurrentReading& reading) const {
    const auto message = startedFrom(&messages->currents);
    message->name = reading.joints;
    message->effort = reading.efforts;
    message->current = reading.currents;
    sender->add(publisher, message);
  }

  void operator()(const sim::OdometryReading& reading) const {
    const auto message = startedFrom(&messages->odometries);
    message->child_frame_id = child_frame_id;
    message->pose.pose.position = toPoint(reading.position);
    message->pose.pose.orientation = toQuaternion(reading.orientation);
    message->twist.twist = toTwist(reading.linear_velocity, reading.angular_velocity);
    for (int diagonal = 0; diagonal < 36; diagonal += 7)
      message->pose.covariance[diagonal] = message->twist.covariance[diagonal] = reading.stddev * reading.stddev;
    sender->add(publisher, message);
  }

  void operator()(const sim::DepthCameraReading& reading) const { ranges->publish(topics, report.time, frame_id, reading.view); }

  void operator()(const sim::LidarReading& reading) const { ranges->publish(topics, report.time, frame_id, reading.view); }
};

ListenedPublisher advertise(ros::NodeHandle* node, sim::SensorType type, const std::string& topic) {
  switch (type) {
    case sim::SensorType::FORCE_TORQUE:
      return ListenedPublisher::advertise<geometry_msgs::WrenchStamped>(node, topic, SENSOR_QUEUE);
    case sim::SensorType::IMU:
    case sim::SensorType::TILT:
      return ListenedPublisher::advertise<sensor_msgs::Imu>(node, topic, SENSOR_QUEUE);
    case sim::SensorType::CONTACT:
      return ListenedPublisher::advertise<ContactsState>(node, topic, SENSOR_QUEUE);
    case sim::SensorType::CONTACT_SWITCH:
      return ListenedPublisher::advertise<std_msgs::Bool>(node, topic, SENSOR_QUEUE);
    case sim::SensorType::CENTRE_OF_PRESSURE:
      return ListenedPublisher::advertise<geometry_msgs::PointStamped>(node, topic, SENSOR_QUEUE);
    case sim::SensorType::MOTOR_CURRENT:
      return ListenedPublisher::advertise<MotorCurrents>(node, topic, SENSOR_QUEUE);
    case sim::SensorType::ODOMETRY:
      return ListenedPublisher::advertise<nav_msgs::Odometry>(node, topic, SENSOR_QUEUE);
    case sim::SensorType::DEPTH_CAMERA:
    case sim::SensorType::LIDAR:
      break;  // RangePublisher's
  }
  throw InputError("sensor topic " + topic + ": this type of sensor has no message");
}

std::string truthTopicOf(const sim::SensorConfig& sensor) { return sim::sensorTopic(sensor) + "/ground_truth"; }

/** The same sensor where it tells the truth: topics below its own. */
sim::SensorConfig truthOf(sim::SensorConfig sensor) {
  sensor.topic = truthTopicOf(sensor);
  sensor.camera_topics = {};
  return sensor;
}

/** A sensor's frame of its own in its link. */
struct Mounting {
  std::string frame;
  Pose X_LF;
};

/** The optical frame of a camera; the frame of another sensor that sits askew in its link, or has a frame_id; none if it is the link's. */
std::optional<Mounting> mountingOf(const sim::SensorConfig& sensor) {
  const std::string told = sensor.type == sim::SensorType::ODOMETRY ? "" : sensor.frame_id;
  if (sensor.type == sim::SensorType::DEPTH_CAMERA) {
    Pose X_SO = Pose::Identity();
    X_SO.linear() = sim::opticalAxes();
    return Mounting{told.empty() ? sensor.name + "_optical_frame" : told, sensor.X_LS * X_SO};
  }
  const std::set<sim::SensorType> sit_anyhow = {sim::SensorType::FORCE_TORQUE, sim::SensorType::IMU,   sim::SensorType::TILT,
                                                sim::SensorType::ODOMETRY,     sim::SensorType::LIDAR, sim::SensorType::CENTRE_OF_PRESSURE};
  const bool sits_anyhow = sit_anyhow.count(sensor.type) > 0;
  if (!sits_anyhow || (told.empty() && sensor.X_LS.isApprox(Pose::Identity(), 1e-12))) return std::nullopt;
  return Mounting{told.empty() ? sensor.name + "_frame" : told, sensor.X_LS};
}

/** Names of frames in a sensor's messages. */
void nameFrames(const sim::RobotInfo& robot, const sim::SensorInfo& sensor, SensorTopic* topic) {
  const std::optional<Mounting> mounting = mountingOf(sensor.config);
  const std::string& told = sensor.config.frame_id;
  const std::string own = ownFrame(robot, mounting ? mounting->frame : sensor.frame_id);
  if (sensor.config.type == sim::SensorType::ODOMETRY) {
    topic->frame = told.empty() ? WORLD_FRAME : namedFrame(robot, told);
    topic->child_frame = own;
  } else {
    topic->frame = told.empty() ? own : namedFrame(robot, told);
  }
}

std::vector<std::string> readingTopicsOf(const sim::SensorConfig& sensor) {
  return sim::isRangeSensor(sensor.type) ? rangeTopics(sim::sensorTopic(sensor), sensor)
                                         : std::vector<std::string>{sim::sensorTopic(sensor)};
}

std::vector<std::string> topicsOf(const sim::SensorConfig& sensor) {
  std::vector<std::string> topics = readingTopicsOf(sensor);
  if (!sim::hasGroundTruth(sensor)) return topics;
  const std::vector<std::string> truth = readingTopicsOf(truthOf(sensor));
  topics.insert(topics.end(), truth.begin(), truth.end());
  return topics;
}

SensorOutlet outletOf(ros::NodeHandle* node, const sim::SensorConfig& sensor) {
  if (sim::isRangeSensor(sensor.type)) return {{}, advertiseRanges(node, sim::sensorTopic(sensor), sensor)};
  return {advertise(node, sensor.type, sim::sensorTopic(sensor)), {}};
}

}  // namespace

SensorPublisher::SensorPublisher(ros::NodeHandle node, const sim::Simulator& simulator, StepSender* sender)
    : simulator_(simulator), sender_(sender), node_(node) {
  modelsChanged();
}

void SensorPublisher::modelsChanged() {
  std::set<std::string> names;
  for (const sim::SensorInfo& sensor : simulator_.sensors())
    for (const std::string& topic : topicsOf(sensor.config)) checkTopic(sensor, topic, &names);
  const auto keyOf = [this](const sim::SensorInfo& sensor) {
    return std::make_pair(simulator_.robots()[sensor.robot].name, sensor.config.name);
  };
  const auto make = [this](const sim::SensorInfo& sensor) {
    ros::NodeHandle robot_node = nodeOf(sensor);
    SensorTopic topic;
    nameFrames(simulator_.robots()[sensor.robot], sensor, &topic);
    topic.readings = outletOf(&robot_node, sensor.config);
    if (sim::hasGroundTruth(sensor.config)) topic.truth = outletOf(&robot_node, truthOf(sensor.config));
    return topic;
  };
  keepTopics(simulator_.sensors(), keyOf, make, &topics_);
  publishMountings();
}

void SensorPublisher::checkTopic(const sim::SensorInfo& sensor, const std::string& topic, std::set<std::string>* names) const {
  if (!isRosName(topic))
    throw InputError("sensors: " + sensor.config.name + ": '" + topic + "' is no ROS topic; use letters, digits, _ and /");
  const std::string name = nodeOf(sensor).resolveName(topic);
  if (!names->insert(name).second)
    throw InputError("sensors: " + sensor.config.name + ": another sensor publishes on " + name + "; set topic");
}

ros::NodeHandle SensorPublisher::nodeOf(const sim::SensorInfo& sensor) const {
  return ros::NodeHandle(node_, simulator_.robots()[sensor.robot].name_space);
}

void SensorPublisher::publishMountings() {
  tf2_msgs::TFMessage message;
  for (const sim::SensorInfo& sensor : simulator_.sensors()) {
    const std::optional<Mounting> mounting = mountingOf(sensor.config);
    const sim::RobotInfo& robot = simulator_.robots()[sensor.robot];
    // The robot's own links are on /tf already.
    if (!mounting || robot.description->linkIndex(mounting->frame) >= 0) continue;
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = ownFrame(robot, sensor.config.link);
    transform.child_frame_id = namedFrame(robot, mounting->frame);
    transform.transform = toTransform(mounting->X_LF);
    message.transforms.push_back(transform);
  }
  if (message.transforms.empty()) return mountings_.shutdown();
  mountings_ = node_.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  mountings_.publish(message);
}

void SensorPublisher::publish(const sim::StepReport& report) {
  for (const sim::SensorSample& sample : report.samples) {
    SensorTopic& topic = topics_[sample.sensor];
    publishReading(report, sample.reading, &topic.readings, &topic);
    if (sample.truth) publishReading(report, *sample.truth, &topic.truth, &topic);
  }
}

void SensorPublisher::publishReading(const sim::StepReport& report, const sim::SensorReading& reading, SensorOutlet* outlet,
                                     SensorTopic* topic) {
  ListenedPublisher* const listened = outlet->publisher ? &*outlet->publisher : nullptr;
  if (listened ? !listened->listened() : !outlet->ranges) return;
  std::visit(
      ReadingPublisher{simulator_, report, topic->frame, topic->child_frame, &topic->messages, listened, outlet->ranges, &ranges_, sender_},
      reading);
}

}  // namespace blem_sim::node
