#include "controllers/trajectory_server.h"

#include <ros/console.h>

#include <utility>

#include "messages/conversions.h"
#include "messages/trajectory_messages.h"

namespace blem_sim::node {

namespace {

constexpr int TRAJECTORY_QUEUE = 100;

JointTrajectoryControllerState namedState(const sim::TrajectoryController& controller) {
  JointTrajectoryControllerState message;
  message.joint_names = controller.joints();
  return message;
}

FollowJointTrajectoryResult resultOf(sim::GoalError error, const std::string& text) {
  FollowJointTrajectoryResult result;
  result.error_code = static_cast<int>(error);
  result.error_string = text;
  return result;
}

void tellOldPoints(const std::string& where, int count) {
  if (count > 0) ROS_WARN("%s: points at or before the next step are left out: %d", where.c_str(), count);
}

}  // namespace

TrajectoryServer::TrajectoryServer(ros::NodeHandle robot_node, sim::TrajectoryController controller, SimulationLoop* loop)
    : controller_(std::move(controller)),
      node_(robot_node, controller_.config().name),
      sender_(loop->sender()),
      state_schedule_(controller_.config().state_publish_rate),
      state_publisher_(ListenedPublisher::advertise<JointTrajectoryControllerState>(&node_, "state", TRAJECTORY_QUEUE)),
      states_(namedState(controller_)),
      query_(node_.advertiseService("query_state", &TrajectoryServer::onQuery, this)),
      goals_(
          {node_, "follow_joint_trajectory", controller_.config().action_monitor_rate, loop->refusals()},
          [this](Goals::Handle goal) { onGoal(goal); },
          [this] {
            controller_.cancel();
            goals_.preempt(resultOf(sim::GoalError::SUCCESSFUL, ""), "cancelled");
          }) {
  commands_ = subscribeCounted<trajectory_msgs::JointTrajectory>(node_, "command", "trajectory refused", loop->refusals(),
                                                                 [this](const auto& message) { onCommand(message); });
}

void TrajectoryServer::onCommand(const trajectory_msgs::JointTrajectory& message) {
  const int old_points = controller_.command(fromMessage(message));
  goals_.preempt(resultOf(sim::GoalError::SUCCESSFUL, ""), "a trajectory came on the topic");
  tellOldPoints(commands_.getTopic(), old_points);
}

void TrajectoryServer::onGoal(Goals::Handle goal) {
  int old_points = 0;
  try {
    old_points = controller_.accept(fromMessage(*goal.getGoal()));
  } catch (const sim::GoalRefused& refusal) {
    return goals_.reject(&goal, resultOf(refusal.error, refusal.what()), refusal.what());
  } catch (const InputError& error) {
    return goals_.reject(&goal, resultOf(sim::GoalError::INVALID_GOAL, error.what()), error.what());
  }
  goals_.activate(goal);
  tellOldPoints(goals_.name(), old_points);
}

bool TrajectoryServer::onQuery(QueryTrajectoryState::Request& request, QueryTrajectoryState::Response& response) {
  try {
    for (const sim::JointSample& sample : controller_.query(request.time.toSec())) {
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

void TrajectoryServer::stop() {
  controller_.stop();
  goals_.preempt(resultOf(sim::GoalError::SUCCESSFUL, ""), "the controller was stopped");
}

void TrajectoryServer::finish(const sim::GoalOutcome& outcome) {
  const FollowJointTrajectoryResult result = resultOf(outcome.error, outcome.text);
  if (outcome.end == sim::GoalEnd::SUCCEEDED) return goals_.succeed(result);
  if (outcome.end == sim::GoalEnd::PREEMPTED) return goals_.preempt(result, outcome.text);
  goals_.abort(result, outcome.text);
  ROS_WARN("%s: %s; the motion goes on", goals_.name().c_str(), outcome.text.c_str());
}

void TrajectoryServer::step(double time) {
  if (const std::optional<sim::GoalOutcome> outcome = controller_.update()) finish(*outcome);
  if (state_schedule_.due(time)) publishState(time);
  if (goals_.feedbackDue(time)) publishFeedback(time);
}

void TrajectoryServer::restartTime() {
  state_schedule_.restart();
  goals_.restartTime();
}

void TrajectoryServer::publishState(double time) {
  if (!controller_.running() || !state_publisher_.listened()) return;
  const auto message = states_.spare();
  message->header.stamp = toStamp(time);
  setTracking(controller_.state(), message.get());
  sender_->add(&state_publisher_, message);
}

void TrajectoryServer::publishFeedback(double time) {
  FollowJointTrajectoryFeedback feedback;
  feedback.header.stamp = toStamp(time);
  feedback.joint_names = controller_.joints();
  setTracking(controller_.state(), &feedback);
  goals_.publish(feedback);
}

}  // namespace blem_sim::node
