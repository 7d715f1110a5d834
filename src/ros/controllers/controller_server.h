// The ROS names of one trajectory controller.
#pragma once

#include <actionlib/server/action_server.h>
#include <blem_sim/FollowJointTrajectoryAction.h>
#include <blem_sim/JointTrajectoryControllerState.h>
#include <blem_sim/QueryTrajectoryState.h>
#include <ros/node_handle.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <string>

#include "blem_sim/sim/trajectory_controller.h"
#include "messages/message_pool.h"
#include "sending/listened_publisher.h"
#include "sending/publish_schedule.h"
#include "sending/step_sender.h"

namespace blem_sim {

/**
 * Below the controller's name: the topic `command` (trajectory_msgs/JointTrajectory), the action `follow_joint_trajectory`, the topic
 * `state` and the service `query_state`. Commands come in the thread that steps, between two steps. A faulty one changes nothing; one error
 * line, and of a goal the result, name the fault.
 */
class ControllerServer {
 public:
  /** @param robot_node in the robot's namespace @throws InputError: wrong settings, see TrajectoryController */
  ControllerServer(ros::NodeHandle robot_node, TrajectoryController controller, StepSender* sender);

  const TrajectoryController& controller() const { return controller_; }
  void start() { controller_.start(); }
  /** A goal ends as pre-empted. */
  void stop();

  /** To be called after each step. */
  void step(double time);
  void restartTime();

 private:
  using ActionServer = actionlib::ActionServer<FollowJointTrajectoryAction>;
  using GoalHandle = ActionServer::GoalHandle;

  void onCommand(const trajectory_msgs::JointTrajectory& message);
  void onGoal(GoalHandle goal);
  void onCancel(GoalHandle goal);
  bool onQuery(QueryTrajectoryState::Request& request, QueryTrajectoryState::Response& response);

  void preempt(const std::string& why);
  void finish(const GoalOutcome& outcome);
  void reject(GoalHandle* goal, GoalError error, const std::string& why) const;
  void tellOldPoints(const std::string& where, int count) const;
  void publishState(double time);
  void publishFeedback(double time);

  TrajectoryController controller_;
  ros::NodeHandle node_;  // below the controller's name
  StepSender* sender_;
  PublishSchedule state_schedule_, feedback_schedule_;
  ListenedPublisher state_publisher_;
  MessagePool<JointTrajectoryControllerState> states_;
  bool has_goal_ = false;
  GoalHandle goal_;  // the active one
  ros::Subscriber commands_;
  ros::ServiceServer query_;
  ActionServer actions_;
};

}  // namespace blem_sim
