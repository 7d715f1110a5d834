#include "controllers/gripper_server.h"

#include <ros/console.h>

#include <utility>

namespace blem_sim::node {

namespace {

/** The action's result and its feedback have the same fields. */
template <typename Message>
Message messageOf(const sim::GripperState& state) {
  Message message;
  message.position = state.position;
  message.effort = state.effort;
  message.stalled = state.stalled;
  message.reached_goal = state.reached_goal;
  return message;
}

}  // namespace

GripperServer::GripperServer(const ros::NodeHandle& robot_node, sim::GripperController controller, Refusals* refusals)
    : controller_(std::move(controller)),
      goals_(
          {ros::NodeHandle(robot_node, controller_.config().name), "gripper_cmd", controller_.config().action_monitor_rate, refusals},
          [this](Goals::Handle goal) { onGoal(goal); },
          [this] {
            controller_.cancel();
            goals_.preempt(messageOf<GripperCommandResult>(controller_.state()), "cancelled");
          }) {}

void GripperServer::onGoal(Goals::Handle goal) {
  const GripperCommand& command = goal.getGoal()->command;
  try {
    controller_.accept(command.position);
  } catch (const InputError& error) {
    return goals_.reject(&goal, messageOf<GripperCommandResult>(controller_.state()), error.what());
  }
  goals_.activate(goal);
  if (command.max_effort != 0)
    ROS_WARN_ONCE("%s: max_effort: the motor's own limit holds; set the robot's effort_limits", goals_.name().c_str());
}

void GripperServer::stop() {
  controller_.stop();
  goals_.preempt(messageOf<GripperCommandResult>(controller_.state()), "the controller was stopped");
}

void GripperServer::finish(const sim::GoalOutcome& outcome) {
  const auto result = messageOf<GripperCommandResult>(controller_.state());
  if (outcome.end == sim::GoalEnd::SUCCEEDED) return goals_.succeed(result);
  if (outcome.end == sim::GoalEnd::PREEMPTED) return goals_.preempt(result, outcome.text);
  goals_.abort(result, outcome.text);
}

void GripperServer::step(double time) {
  if (const std::optional<sim::GoalOutcome> outcome = controller_.update()) finish(*outcome);
  if (goals_.feedbackDue(time)) goals_.publish(messageOf<GripperCommandFeedback>(controller_.state()));
}

}  // namespace blem_sim::node
