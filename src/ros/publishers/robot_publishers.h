// Topics of every robot: joint states, the pose of its root link.
#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "loop/root_frames.h"
#include "loop/simulation_loop.h"
#include "messages/message_pool.h"
#include "sending/greeting_publisher.h"
#include "sending/publish_schedule.h"
#include "sending/step_publisher.h"
#include "sending/step_sender.h"

namespace blem_sim::node {

/** Topic of a robot. */
template <typename Message>
struct RobotTopic {
  std::string key;  ///< name of the robot
  GreetingPublisher<Message> publisher;
  MessagePool<Message> messages;
};

/** `joint_states` in each robot's namespace: position, velocity and effort of every movable joint. Told late subscribers. */
class JointStatePublisher : public StepPublisher {
 public:
  JointStatePublisher(ros::NodeHandle node, const sim::Simulator& simulator, StepSender* sender);
  void publish(const sim::StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }
  void modelsChanged() override;

 private:
  ros::NodeHandle node_;
  const sim::Simulator& simulator_;
  PublishSchedule schedule_;
  StepSender* sender_;
  std::vector<RobotTopic<sensor_msgs::JointState>> topics_;  // per robot; names are filled in once
};

/** `odom`, or as told, in each robot's namespace: ground truth of the root link, twist in its own axes. Told late subscribers. */
class OdometryPublisher : public StepPublisher {
 public:
  OdometryPublisher(ros::NodeHandle node, const sim::Simulator& simulator, StepSender* sender);
  void publish(const sim::StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }
  void modelsChanged() override;

 private:
  ros::NodeHandle node_;
  const sim::Simulator& simulator_;
  PublishSchedule schedule_;
  StepSender* sender_;
  std::vector<RobotTopic<nav_msgs::Odometry>> topics_;  // per robot
};

/**
 * /tf: world to each object, and of each robot with publish_tf: world to the root link, unless that is the frame world itself or in that of
 * a running drive's odometry, and to its odometry's frame, and what robot_state_publisher leaves out: children of floating and planar
 * joints in their parents. Told late subscribers during a pause, so that rviz sees where everything stands. No stamp comes twice, after a
 * reset at 0 s neither: tf2 warns of that.
 */
class TransformPublisher : public StepPublisher {
 public:
  TransformPublisher(ros::NodeHandle node, SimulationLoop* loop);
  void publish(const sim::StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }

 private:
  void addRobot(const sim::StepReport& report, const sim::RobotInfo& robot, tf2_msgs::TFMessage* message) const;

  const sim::Simulator& simulator_;
  const RootFrames& drives_;
  PublishSchedule schedule_;
  StepSender* sender_;
  GreetingPublisher<tf2_msgs::TFMessage> publisher_;
  double last_time_ = -1;  // [s]
  MessagePool<tf2_msgs::TFMessage> messages_;
};

}  // namespace blem_sim::node
