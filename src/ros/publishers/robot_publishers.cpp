#include "publishers/robot_publishers.h"

#include "messages/conversions.h"
#include "messages/link_motion.h"

namespace blem_sim {

namespace {
constexpr int QUEUE_SIZE = 100;
}

JointStatePublisher::JointStatePublisher(ros::NodeHandle node, const Simulator& simulator, StepSender* sender)
    : simulator_(simulator), schedule_(simulator.config().rates.joint_state), sender_(sender) {
  for (const RobotInfo& robot : simulator.robots()) {
    ros::NodeHandle robot_node(node, robot.name_space);
    publishers_.emplace_back(&robot_node, "joint_states", QUEUE_SIZE);
    sensor_msgs::JointState message;
    message.name = robot.joint_names;
    message.position.resize(robot.joints.size());
    message.velocity.resize(robot.joints.size());
    message.effort.resize(robot.joints.size());
    messages_.emplace_back(message);
  }
}

void JointStatePublisher::publish(const StepReport& report) {
  if (!schedule_.due(report.time)) return;
  for (std::size_t robot = 0; robot < publishers_.size(); ++robot) {
    const auto message = messages_[robot].spare();
    message->header.stamp = toStamp(report.time);
    const std::vector<int>& joints = simulator_.robots()[robot].joints;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const JointState& state = report.joints[joints[i]];
      message->position[i] = state.position;
      message->velocity[i] = state.velocity;
      message->effort[i] = state.effort;
    }
    sender_->add(&publishers_[robot], message);
  }
}

OdometryPublisher::OdometryPublisher(ros::NodeHandle node, const Simulator& simulator, StepSender* sender)
    : simulator_(simulator), schedule_(simulator.config().rates.odom), sender_(sender) {
  for (const RobotInfo& robot : simulator.robots()) {
    ros::NodeHandle robot_node(node, robot.name_space);
    publishers_.emplace_back(&robot_node, "odom", QUEUE_SIZE);
  }
}

void OdometryPublisher::publish(const StepReport& report) {
  if (!schedule_.due(report.time)) return;
  for (std::size_t i = 0; i < publishers_.size(); ++i) {
    const RobotInfo& robot = simulator_.robots()[i];
    const LinkMotion root = linkMotion(simulator_, report, robot, robot.description->root);
    const auto message = messages_.spare();
    message->header.stamp = toStamp(report.time);
    message->header.frame_id = WORLD_FRAME;
    message->child_frame_id = robot.root_link;
    message->pose.pose = toPose(root.X_WL);
    const Matrix3 R_LW = root.X_WL.linear().transpose();
    message->twist.twist = toTwist(R_LW * root.v_WL, R_LW * root.w_WL);
    sender_->add(&publishers_[i], message);
  }
}

TransformPublisher::TransformPublisher(ros::NodeHandle node, const Simulator& simulator, StepSender* sender)
    : simulator_(simulator), schedule_(simulator.config().rates.tf), sender_(sender), publisher_(&node, "/tf", QUEUE_SIZE) {}

void TransformPublisher::publish(const StepReport& report) {
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
  for (const RobotInfo& robot : simulator_.robots()) {
    if (robot.root_link != WORLD_FRAME) add(robot.root_link, linkMotion(simulator_, report, robot, robot.description->root).X_WL);
  }
  for (const ModelInfo& model : simulator_.models()) {
    if (model.kind == ModelKind::OBJECT && model.alive) add(model.name, bodyMotion(simulator_, report, model.bodies.front()).X_WL);
  }
  if (!message->transforms.empty()) sender_->add(&publisher_, message);
}

}  // namespace blem_sim
