// The ROS names of one drive.
#pragma once

#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "blem_sim/sim/drive_controller.h"
#include "controllers/controller_server.h"
#include "loop/simulation_loop.h"
#include "messages/message_pool.h"
#include "sending/greeting_publisher.h"
#include "sending/publish_schedule.h"

namespace blem_sim::node {

/**
 * Topics `cmd_vel` (geometry_msgs/Twist) and `odom` (nav_msgs/Odometry), below the controller's name or as told, and /tf. Late subscribers
 * are told. While a drive with enable_odom_tf runs, the root link is in its odometry's frame and not in the world.
 */
class DriveServer : public ControllerServer {
 public:
  /** @param robot_node in the robot's namespace @throws InputError: a topic that is none */
  DriveServer(ros::NodeHandle robot_node, sim::DriveController controller, SimulationLoop* loop);
  ~DriveServer() override { leaveFrame(); }

  std::vector<std::string> joints() const override { return controller_.claims(); }
  void start() override;
  void stop() override;
  void step(double time) override;
  void restartTime() override { schedule_.restart(); }

 private:
  void leaveFrame();
  void publish(double time);
  /** The root link in the frame of odometry, so that a base below it has one parent. */
  void publishTransform(double time, const sim::DriveOdometry& odometry);
  const sim::RobotInfo& robotInfo() const { return loop_->simulator().robots()[controller_.robot()]; }

  sim::DriveController controller_;
  SimulationLoop* loop_;
  std::string framed_robot_;         // whose root link it has in its frame; empty: none
  double last_transform_time_ = -1;  // [s]
  PublishSchedule schedule_;
  GreetingPublisher<nav_msgs::Odometry> odometry_publisher_;
  GreetingPublisher<tf2_msgs::TFMessage> transform_publisher_;
  MessagePool<nav_msgs::Odometry> odometries_;
  MessagePool<tf2_msgs::TFMessage> transforms_;
  ros::Subscriber commands_;
};

}  // namespace blem_sim::node
