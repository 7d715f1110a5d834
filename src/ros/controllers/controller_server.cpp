#include "controllers/controller_server.h"

#include <ros/console.h>

#include <boost/function.hpp>
#include <utility>

#include "messages/conversions.h"
#include "messages/trajectory_messages.h"

namespace blem_sim {

namespace {

constexpr int QUEUE_SIZE = 100;

JointTrajectoryControllerState namedState(const TrajectoryController& controller) {
  JointTrajectoryControllerState message;
  message.joint_names = controller.joints();
  return message;
}

FollowJointTrajectoryResult resultOf(GoalError error, const std::string& text) {
  FollowJointTrajectoryResult result;
  result.error_code = static_cast<int>(error);
  result.error_string = text;
  return result;
}

}  // namespace

ControllerServer::ControllerServer(ros::NodeHandle robot_node, TrajectoryController controller, StepSender* sender)
    : controller_(std::move(controller)),
      node_(robot_node, controller_.config().name),
      sender_(sender),
      state_schedule_(controller_.config().state_publish_rate),
      feedback_schedule_(controller_.config().action_monitor_rate),
      state_publisher_(ListenedPublisher::advertise<JointTrajectoryControllerState>(&node_, "state", QUEUE_SIZE)),
      states_(namedState(controller_)),
      query_(node_.advertiseService("query_state", &ControllerServer::onQuery, this)),
      actions_(
          node_, "follow_joint_trajectory", [this](GoalHandle goal) { onGoal(goal); }, [this](GoalHandle goal) { onCancel(goal); }, false) {
  const boost::function<void(const trajectory_msgs::JointTrajectoryConstPtr&)> on_command =
      [this](const trajectory_msgs::JointTrajectoryConstPtr& message) { onCommand(*message); };
  commands_ = node_.subscribe<trajectory_msgs::JointTrajectory>("command", QUEUE_SIZE, on_command);
  actions_.start();
}

void ControllerServer::onCommand(const trajectory_msgs::JointTrajectory& message) {
  const std::string topic = commands_.getTopic();
  try {
    const int old_points = controller_.command(fromMessage(message));
    preempt("a trajectory came on the topic");
    tellOldPoints(topic, old_points);
  } catch (const InputError& error) {
    ROS_ERROR("%s: trajectory refused: %s", topic.c_str(), error.what());
  }
}

void ControllerServer::onGoal(GoalHandle goal) {
  int old_points = 0;
  try {
    old_points = controller_.accept(fromMessage(*goal.getGoal()));
  } catch (const GoalRefused& refusal) {
    return reject(&goal, refusal.error, refusal.what());
  } catch (const InputError& error) {
    return reject(&goal, GoalError::INVALID_GOAL, error.what());
  }
  preempt("a new goal came");
  goal.setAccepted();
  goal_ = goal;
  has_goal_ = true;
  feedback_schedule_.restart();
  tellOldPoints(node_.resolveName("follow_joint_trajectory"), old_points);
}

void ControllerServer::onCancel(GoalHandle goal) {
  if (!has_goal_ || !(goal == goal_)) return;
  controller_.cancel();
  preempt("cancelled");
}

bool ControllerServer::onQuery(QueryTrajectoryState::Request& request, QueryTrajectoryState::Response& response) {
  try {
    for (const JointSample& sample : controller_.query(request.time.toSec())) {
      response.position.push_back(sample.position);
      response.velocity.push_back(sample.velocity);
      response.acceleration.push_back(sample.acceleration);
    }
  } catch (const InputError& error) {
    ROS_ERROR("%s: %s", query_.getService().c_str(), error.what());
    return false;
  }
  response.name = controller_.joints();
  return true;
}

void ControllerServer::stop() {
  controller_.stop();
  preempt("the controller was stopped");
}

void ControllerServer::preempt(const std::string& why) {
  if (!has_goal_) return;
  has_goal_ = false;
  goal_.setCanceled(resultOf(GoalError::SUCCESSFUL, ""), why);
}

void ControllerServer::finish(const GoalOutcome& outcome) {
  if (outcome.end == GoalEnd::PREEMPTED) return preempt(outcome.text);
  has_goal_ = false;
  if (outcome.end == GoalEnd::SUCCEEDED) return goal_.setSucceeded(resultOf(outcome.error, outcome.text));
  goal_.setAborted(resultOf(outcome.error, outcome.text), outcome.text);
  ROS_WARN("%s: %s; the motion goes on", node_.resolveName("follow_joint_trajectory").c_str(), outcome.text.c_str());
}

void ControllerServer::reject(GoalHandle* goal, GoalError error, const std::string& why) const {
  goal->setRejected(resultOf(error, why), why);
  ROS_ERROR("%s: goal refused: %s", node_.resolveName("follow_joint_trajectory").c_str(), why.c_str());
}

void ControllerServer::tellOldPoints(const std::string& where, int count) const {
  if (count > 0) ROS_WARN("%s: points at or before the next step are left out: %d", where.c_str(), count);
}

void ControllerServer::step(double time) {
  if (const std::optional<GoalOutcome> outcome = controller_.update()) finish(*outcome);
  if (state_schedule_.due(time)) publishState(time);
  if (has_goal_ && feedback_schedule_.due(time)) publishFeedback(time);
}

void ControllerServer::restartTime() {
  state_schedule_.restart();
  feedback_schedule_.restart();
}

void ControllerServer::publishState(double time) {
  if (!controller_.running() || !state_publisher_.listened()) return;
  const auto message = states_.spare();
  message->header.stamp = toStamp(time);
  setTracking(controller_.state(), message.get());
  sender_->add(&state_publisher_, message);
}

void ControllerServer::publishFeedback(double time) {
  FollowJointTrajectoryFeedback feedback;
  feedback.header.stamp = toStamp(time);
  feedback.joint_names = controller_.joints();
  setTracking(controller_.state(), &feedback);
  goal_.publishFeedback(feedback);
}

}  // namespace blem_sim
