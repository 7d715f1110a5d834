#include "publishers/sensor_publisher.h"

#include <ros/names.h>
#include <tf2_msgs/TFMessage.h>
#include <boost/make_shared.hpp>

#include <set>

#include "blem_sim/geometry/input_error.h"
#include "messages/contact_messages.h"
#include "messages/conversions.h"

namespace blem_sim {

namespace {

// Sensors run at every step by default; a subscriber may be a moment late.
constexpr int QUEUE_SIZE = 1000;

template <typename Covariance>
void setVariance(Covariance* covariance, double stddev) {
  for (const int diagonal : {0, 4, 8}) (*covariance)[diagonal] = stddev * stddev;
}

/** One conversion and one publication per kind of reading; does not compile until a new kind has its own. */
struct ReadingPublisher {
  const Simulator& simulator;
  const StepReport& report;
  const std::string& frame_id;
  SensorMessages* messages;
  ListenedPublisher* publisher;
  StepSender* sender;

  template <typename Message>
  boost::shared_ptr<Message> startedFrom(MessagePool<Message>* pool) const {
    const boost::shared_ptr<Message> message = pool->spare();
    message->header.stamp = toStamp(report.time);
    message->header.frame_id = frame_id;
    return message;
  }

  void operator()(const ForceTorqueReading& reading) const {
    const auto message = startedFrom(&messages->wrenches);
    if (!reading.frame_id.empty()) message->header.frame_id = reading.frame_id;
    message->wrench = toWrench(reading.force, reading.torque);
    sender->add(publisher, message);
  }

  void operator()(const ImuReading& reading) const {
    const auto message = startedFrom(&messages->imus);
    message->orientation = toQuaternion(reading.orientation);
    message->angular_velocity = toVector3(reading.angular_velocity);
    message->linear_acceleration = toVector3(reading.linear_acceleration);
    setVariance(&message->angular_velocity_covariance, reading.gyro_stddev);
    setVariance(&message->linear_acceleration_covariance, reading.accel_stddev);
    sender->add(publisher, message);
  }

  void operator()(const ContactReading& reading) const {
    sender->add(publisher, boost::make_shared<ContactsState>(toContactsState(simulator, report, reading)));
  }

  void operator()(const TiltReading& reading) const {
    const auto message = startedFrom(&messages->imus);
    message->orientation = toQuaternion(reading.orientation);
    message->angular_velocity = toVector3(reading.angular_velocity);
    message->linear_acceleration_covariance[0] = -1;  // sensor_msgs: not measured
    sender->add(publisher, message);
  }

  void operator()(const MotorCurrentReading& reading) const {
    const auto message = startedFrom(&messages->currents);
    message->name = reading.joints;
    message->effort = reading.efforts;
    message->current = reading.currents;
    sender->add(publisher, message);
  }
};

ListenedPublisher advertise(ros::NodeHandle* node, SensorType type, const std::string& topic) {
  switch (type) {
    case SensorType::FORCE_TORQUE:
      return ListenedPublisher::advertise<geometry_msgs::WrenchStamped>(node, topic, QUEUE_SIZE);
    case SensorType::IMU:
    case SensorType::TILT:
      return ListenedPublisher::advertise<sensor_msgs::Imu>(node, topic, QUEUE_SIZE);
    case SensorType::CONTACT:
      return ListenedPublisher::advertise<ContactsState>(node, topic, QUEUE_SIZE);
    case SensorType::MOTOR_CURRENT:
      return ListenedPublisher::advertise<MotorCurrents>(node, topic, QUEUE_SIZE);
  }
  throw InputError("sensor topic " + topic + ": this type of sensor has no message");
}

bool sitsAskew(const SensorConfig& sensor) {
  return (sensor.type == SensorType::IMU || sensor.type == SensorType::TILT) && !sensor.X_LS.isApprox(Pose::Identity(), 1e-12);
}

}  // namespace

SensorPublisher::SensorPublisher(ros::NodeHandle node, const Simulator& simulator, StepSender* sender)
    : simulator_(simulator), sender_(sender), node_(node) {
  std::set<std::string> topics;
  for (const SensorInfo& sensor : simulator.sensors()) {
    const SensorConfig& config = sensor.config;
    ros::NodeHandle robot_node(node, simulator.robots()[sensor.robot].name_space);
    const std::string topic = config.topic.empty() ? config.name : config.topic;
    std::string error;
    if (topic.empty() || !ros::names::validate(topic, error)) {
      throw InputError("sensors: " + config.name + ": '" + topic + "' is no ROS topic; use letters, digits, _ and /");
    }
    if (!topics.insert(robot_node.resolveName(topic)).second) {
      throw InputError("sensors: " + config.name + ": another sensor publishes on " + robot_node.resolveName(topic) + "; set topic");
    }
    publishers_.push_back(advertise(&robot_node, config.type, topic));
    frames_.push_back(sitsAskew(config) ? config.name + "_frame" : sensor.frame_id);
  }
  messages_.resize(publishers_.size());
  publishMountings();
}

void SensorPublisher::publishMountings() {
  tf2_msgs::TFMessage message;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const SensorConfig& config = simulator_.sensors()[i].config;
    if (!sitsAskew(config)) continue;
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = config.link;
    transform.child_frame_id = frames_[i];
    transform.transform = toTransform(config.X_LS);
    message.transforms.push_back(transform);
  }
  if (message.transforms.empty()) return;
  mountings_ = node_.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  mountings_.publish(message);
}

void SensorPublisher::publish(const StepReport& report) {
  for (const SensorSample& sample : report.samples) {
    ListenedPublisher& publisher = publishers_[sample.sensor];
    if (!publisher.listened()) continue;
    std::visit(ReadingPublisher{simulator_, report, frames_[sample.sensor], &messages_[sample.sensor], &publisher, sender_},
               sample.reading);
  }
}

}  // namespace blem_sim
