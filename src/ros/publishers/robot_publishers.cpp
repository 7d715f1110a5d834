#include "publishers/robot_publishers.h"

#include "messages/conversions.h"
#include "messages/joint_messages.h"
#include "messages/link_motion.h"
#include "publishers/robot_topics.h"

namespace blem_sim::node {

namespace {
constexpr int ROBOT_QUEUE = 100;

const std::string& nameOf(const sim::RobotInfo& robot) { return robot.name; }
}  // namespace

JointStatePublisher::JointStatePublisher(ros::NodeHandle node, const sim::Simulator& simulator, StepSender* sender)
    : node_(node), simulator_(simulator), schedule_(simulator.config().rates.joint_state), sender_(sender) {
  modelsChanged();
}

void JointStatePublisher::modelsChanged() {
  const auto make = [this](const sim::RobotInfo& robot) {
    ros::NodeHandle robot_node(node_, robot.name_space);
    return RobotTopic<sensor_msgs::JointState>{
        "", {&robot_node, "joint_states", ROBOT_QUEUE}, MessagePool<sensor_msgs::JointState>(statesOf(robot))};
  };
  keepTopics(simulator_.robots(), nameOf, make, &topics_);
}

void JointStatePublisher::publish(const sim::StepReport& report) {
  if (!schedule_.due(report.time)) return;
  for (std::size_t robot = 0; robot < topics_.size(); ++robot) {
    const auto message = topics_[robot].messages.spare();
    writeStates(report, simulator_.robots()[robot], message.get());
    sender_->add(&topics_[robot].publisher, message);
  }
}

OdometryPublisher::OdometryPublisher(ros::NodeHandle node, const sim::Simulator& simulator, StepSender* sender)
    : node_(node), simulator_(simulator), schedule_(simulator.config().rates.odom), sender_(sender) {
  modelsChanged();
}

void OdometryPublisher::modelsChanged() {
  const auto make = [this](const sim::RobotInfo& robot) {
    ros::NodeHandle robot_node(node_, robot.name_space);
    return RobotTopic<nav_msgs::Odometry>{"", {&robot_node, "odom", ROBOT_QUEUE}, MessagePool<nav_msgs::Odometry>()};
  };
  keepTopics(simulator_.robots(), nameOf, make, &topics_);
}

void OdometryPublisher::publish(const sim::StepReport& report) {
  if (!schedule_.due(report.time)) return;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const sim::RobotInfo& robot = simulator_.robots()[i];
    const LinkMotion root = linkMotion(simulator_, report, robot, robot.description->root);
    const auto message = topics_[i].messages.spare();
    message->header.stamp = toStamp(report.time);
    message->header.frame_id = WORLD_FRAME;
    message->child_frame_id = robot.root_link;
    message->pose.pose = toPose(root.X_WL);
    const Matrix3 R_LW = root.X_WL.linear().transpose();
    message->twist.twist = toTwist(R_LW * root.v_WL, R_LW * root.w_WL);
    sender_->add(&topics_[i].publisher, message);
  }
}

TransformPublisher::TransformPublisher(ros::NodeHandle node, const sim::Simulator& simulator, StepSender* sender)
    : simulator_(simulator), schedule_(simulator.config().rates.tf), sender_(sender), publisher_(&node, "/tf", ROBOT_QUEUE) {}

void TransformPublisher::publish(const sim::StepReport& report) {
  if (!schedule_.due(report.time)) return;
  const auto message = messages_.spare();
  message->transforms.clear();
  const auto add = [&](const std::string& frame, const Pose& X_WF) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = toStamp(report.time);
    transform.header.frame_id = WORLD_FRAME;
    transform.child_frame_id = frame;
    transform.transform = toTransform(X_WF);
    message->transforms.push_back(transform);
  };
  for (const sim::RobotInfo& robot : simulator_.robots()) {
    if (robot.root_link != WORLD_FRAME) add(robot.root_link, linkMotion(simulator_, report, robot, robot.description->root).X_WL);
  }
  for (const sim::ModelInfo& model : simulator_.models()) {
    if (model.kind == sim::ModelKind::OBJECT && model.alive) add(model.name, bodyMotion(simulator_, report, model.bodies.front()).X_WL);
  }
  if (!message->transforms.empty()) sender_->add(&publisher_, message);
}

}  // namespace blem_sim::node
