#pragma once

#include <blem_sim/MotorCurrents.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Bool.h>

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "messages/message_pool.h"
#include "publishers/ranges/range_publisher.h"
#include "sending/listened_publisher.h"
#include "sending/step_publisher.h"
#include "sending/step_sender.h"

namespace blem_sim::node {

/** Messages of one sensor: those of its type are used. */
struct SensorMessages {
  MessagePool<geometry_msgs::WrenchStamped> wrenches;
  MessagePool<sensor_msgs::Imu> imus;
  MessagePool<MotorCurrents> currents;
  MessagePool<nav_msgs::Odometry> odometries;
  MessagePool<std_msgs::Bool> switches;
  MessagePool<geometry_msgs::PointStamped> points;
};

/** Publishers of a sensor's readings. */
struct SensorOutlet {
  std::optional<ListenedPublisher> publisher;  ///< none for cameras and lidars
  std::shared_ptr<const RangeTopics> ranges;   ///< for them alone
};

/** Topic of a sensor. */
struct SensorTopic {
  std::pair<std::string, std::string> key;  ///< names of the robot and the sensor
  std::string frame;                        ///< frame_id of its messages
  std::string child_frame;                  ///< child_frame_id of odometry
  SensorOutlet readings;
  SensorOutlet truth;  ///< of what the sensor would read without error, if it makes any
  SensorMessages messages;
};

/** One topic per sensor, in its robot's namespace; a sensor's rate was kept when it was sampled. */
class SensorPublisher : public StepPublisher {
 public:
  /** @throws InputError: a sensor's topic is no valid ROS name, or two sensors share one */
  SensorPublisher(ros::NodeHandle node, const sim::Simulator& simulator, StepSender* sender);
  void publish(const sim::StepReport& report) override;
  void modelsChanged() override;
  void drain() override { ranges_.drain(); }

 private:
  /** @param names those of all topics so far */
  void checkTopic(const sim::SensorInfo& sensor, const std::string& topic, std::set<std::string>* names) const;
  void publishMountings();
  /** @param outlet one of the topic's, which may be none */
  void publishReading(const sim::StepReport& report, const sim::SensorReading& reading, SensorOutlet* outlet, SensorTopic* topic);
  ros::NodeHandle nodeOf(const sim::SensorInfo& sensor) const;

  const sim::Simulator& simulator_;
  StepSender* sender_;
  ros::NodeHandle node_;
  std::vector<SensorTopic> topics_;  // per sensor
  RangePublisher ranges_;
  ros::Publisher mountings_;  // /tf_static of sensors that sit askew in their link
};

}  // namespace blem_sim::node
