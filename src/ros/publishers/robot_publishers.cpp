#include "publishers/robot_publishers.h"

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/link_motion.h"
#include "messages/conversions.h"
#include "messages/joint_messages.h"
#include "messages/ros_names.h"
#include "publishers/robot_topics.h"

namespace blem_sim::node {

namespace {
constexpr int ROBOT_QUEUE = 100;

const std::string& nameOf(const sim::RobotInfo& robot) { return robot.name; }

/** Topic of a robot's odometry. @throws InputError if it is none */
const std::string& topicOf(const sim::RobotInfo& robot) {
  if (isRosName(robot.odom.topic)) return robot.odom.topic;
  throw InputError("robots: " + robot.name + ": odom.topic: '" + robot.odom.topic + "' is no ROS topic; use letters, digits, _ and /");
}

/** A frame in another one. */
struct Frame {
  std::string parent, name;
  Pose X_PF;
};

void add(const Frame& frame, double time, tf2_msgs::TFMessage* message) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = toStamp(time);
  transform.header.frame_id = frame.parent;
  transform.child_frame_id = frame.name;
  transform.transform = toTransform(frame.X_PF);
  message->transforms.push_back(transform);
}

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
    return RobotTopic<nav_msgs::Odometry>{"", {&robot_node, topicOf(robot), ROBOT_QUEUE}, MessagePool<nav_msgs::Odometry>()};
  };
  keepTopics(simulator_.robots(), nameOf, make, &topics_);
}

void OdometryPublisher::publish(const sim::StepReport& report) {
  if (!schedule_.due(report.time)) return;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const sim::RobotInfo& robot = simulator_.robots()[i];
    const sim::LinkMotion root = linkMotion(simulator_, report, robot, robot.description->root);
    const auto message = topics_[i].messages.spare();
    message->header.stamp = toStamp(report.time);
    message->header.frame_id = namedFrame(robot, robot.odom.frame);
    message->child_frame_id = ownFrame(robot, robot.root_link);
    message->pose.pose = toPose(robot.odom.X_WF.inverse() * root.X_WL);
    const Matrix3 R_LW = root.X_WL.linear().transpose();
    message->twist.twist = toTwist(R_LW * root.v_WL, R_LW * root.w_WL);
    sender_->add(&topics_[i].publisher, message);
  }
}

TransformPublisher::TransformPublisher(ros::NodeHandle node, SimulationLoop* loop)
    : simulator_(loop->simulator()),
      drives_(*loop->rootFrames()),
      schedule_(simulator_.config().rates.tf),
      sender_(loop->sender()),
      publisher_(&node, "/tf", ROBOT_QUEUE) {}

void TransformPublisher::publish(const sim::StepReport& report) {
  if (!schedule_.due(report.time) || report.time == last_time_) return;
  last_time_ = report.time;
  const auto message = messages_.spare();
  message->transforms.clear();
  for (const sim::RobotInfo& robot : simulator_.robots())
    if (robot.publish_tf) addRobot(report, robot, message.get());
  for (const sim::ModelInfo& model : simulator_.models()) {
    if (model.kind == sim::ModelKind::OBJECT && model.alive)
      add({WORLD_FRAME, model.name, bodyMotion(simulator_, report, model.bodies.front()).X_WL}, report.time, message.get());
  }
  if (!message->transforms.empty()) sender_->add(&publisher_, message);
}

void TransformPublisher::addRobot(const sim::StepReport& report, const sim::RobotInfo& robot, tf2_msgs::TFMessage* message) const {
  const auto poseOf = [&](int link) { return linkMotion(simulator_, report, robot, link).X_WL; };
  const auto frameOf = [&](int link) { return ownFrame(robot, robot.description->links[link].name); };
  const std::string root = ownFrame(robot, robot.root_link), odom = namedFrame(robot, robot.odom.frame);
  if (root != WORLD_FRAME && !drives_.taken(robot.name)) add({WORLD_FRAME, root, poseOf(robot.description->root)}, report.time, message);
  if (odom != WORLD_FRAME) add({WORLD_FRAME, odom, robot.odom.X_WF}, report.time, message);
  for (const model::JointModel& joint : robot.description->joints) {
    if (joint.type != model::JointType::FLOATING && joint.type != model::JointType::PLANAR) continue;
    add({frameOf(joint.parent), frameOf(joint.child), poseOf(joint.parent).inverse() * poseOf(joint.child)}, report.time, message);
  }
}

}  // namespace blem_sim::node
