#include "controllers/drive_server.h"

#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "messages/conversions.h"
#include "messages/ros_names.h"

namespace blem_sim::node {

namespace {

constexpr int DRIVE_QUEUE = 100;

/** A topic of a drive. @throws InputError if it is none */
std::string checked(const sim::ControllerConfig& config, const char* key, const std::string& topic) {
  if (isRosName(topic)) return topic;
  throw InputError("controller '" + config.name + "': " + key + ": '" + topic + "' is no ROS topic; use letters, digits, _ and /");
}

nav_msgs::Odometry withCovariances(const sim::DriveConfig& drive) {
  nav_msgs::Odometry message;
  constexpr std::size_t DIAGONAL = 7;  // steps of it in the matrix of 6 x 6
  for (std::size_t i = 0; i < drive.pose_covariance.size(); ++i) {
    message.pose.covariance[DIAGONAL * i] = drive.pose_covariance[i];
    message.twist.covariance[DIAGONAL * i] = drive.twist_covariance[i];
  }
  return message;
}

}  // namespace

DriveServer::DriveServer(ros::NodeHandle robot_node, sim::DriveController controller, SimulationLoop* loop)
    : controller_(std::move(controller)),
      loop_(loop),
      schedule_(controller_.config().drive.publish_rate),
      odometry_publisher_(&robot_node, checked(controller_.config(), "odom_topic", odometryTopic(controller_.config())), DRIVE_QUEUE),
      transform_publisher_(&robot_node, "/tf", DRIVE_QUEUE),
      odometries_(withCovariances(controller_.config().drive)) {
  const std::string topic = checked(controller_.config(), "cmd_vel_topic", commandTopic(controller_.config()));
  commands_ =
      subscribeCounted<geometry_msgs::Twist>(robot_node, topic.c_str(), "command refused", loop->refusals(), [this](const auto& message) {
        controller_.command({message.linear.x, message.angular.z, message.linear.y});
      });
}

void DriveServer::start() {
  controller_.start();
  const sim::DriveConfig& drive = controller_.config().drive;
  if (!drive.enable_odom_tf || drive.publish_rate == sim::RATE_OFF || !framed_robot_.empty()) return;
  framed_robot_ = robotInfo().name;
  loop_->rootFrames()->take(framed_robot_);
}

void DriveServer::stop() {
  controller_.stop();
  leaveFrame();
}

void DriveServer::leaveFrame() {
  if (!framed_robot_.empty()) loop_->rootFrames()->giveBack(framed_robot_);
  framed_robot_.clear();
}

void DriveServer::step(double time) {
  controller_.update();
  if (controller_.running() && schedule_.due(time)) publish(time);
}

void DriveServer::publish(double time) {
  const sim::DriveOdometry odometry = controller_.odometry();
  const sim::RobotInfo& robot = robotInfo();
  const auto message = odometries_.spare();
  message->header.stamp = toStamp(time);
  message->header.frame_id = namedFrame(robot, controller_.config().drive.odom_frame);
  message->child_frame_id = ownFrame(robot, robot.description->links[controller_.base()].name);
  message->pose.pose = toPose(odometry.X_OB);
  message->twist.twist = toTwist(odometry.v_OB, odometry.w_OB);
  loop_->sender()->add(&odometry_publisher_, message);
  if (!framed_robot_.empty()) publishTransform(time, odometry);
}

void DriveServer::publishTransform(double time, const sim::DriveOdometry& odometry) {
  if (time == last_transform_time_) return;  // tf2 warns of a stamp that comes twice
  last_transform_time_ = time;
  const sim::RobotInfo& robot = robotInfo();
  const sim::Simulator& simulator = loop_->simulator();
  const int index = controller_.robot(), root = robot.description->root;
  const auto message = transforms_.spare();
  message->transforms.resize(1);
  geometry_msgs::TransformStamped& transform = message->transforms.front();
  transform.header.stamp = toStamp(time);
  transform.header.frame_id = namedFrame(robot, controller_.config().drive.odom_frame);
  transform.child_frame_id = ownFrame(robot, robot.root_link);
  const Pose X_BR = simulator.linkPose(index, controller_.base()).inverse() * simulator.linkPose(index, root);
  transform.transform = toTransform(odometry.X_OB * X_BR);
  loop_->sender()->add(&transform_publisher_, message);
}

}  // namespace blem_sim::node
