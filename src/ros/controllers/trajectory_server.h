// The ROS names of one trajectory controller.
#pragma once

#include <blem_sim/FollowJointTrajectoryAction.h>
#include <blem_sim/JointTrajectoryControllerState.h>
#include <blem_sim/QueryTrajectoryState.h>
#include <ros/node_handle.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <string>
#include <vector>

#include "blem_sim/sim/trajectory_controller.h"
#include "controllers/controller_server.h"
#include "controllers/goal_server.h"
#include "loop/simulation_loop.h"
#include "messages/message_pool.h"
#include "sending/listened_publisher.h"

namespace blem_sim::node {

/**
 * Below the controller's name: the topic `command` (trajectory_msgs/JointTrajectory), the action `follow_joint_trajectory`, the topic
 * `state` and the service `query_state`. The result of a refused goal names the fault, too.
 */
class TrajectoryServer : public ControllerServer {
 public:
  /** @param robot_node in the robot's namespace */
  TrajectoryServer(ros::NodeHandle robot_node, sim::TrajectoryController controller, SimulationLoop* loop);

  std::vector<std::string> joints() const override { return controller_.joints(); }
  void start() override { controller_.start(); }
  void stop() override;
  void step(double time) override;
  void restartTime() override;

 private:
  using Goals = GoalServer<FollowJointTrajectoryAction>;

  void onCommand(const trajectory_msgs::JointTrajectory& message);
  void onGoal(Goals::Handle goal);
  bool onQuery(QueryTrajectoryState::Request& request, QueryTrajectoryState::Response& response);

  void finish(const sim::GoalOutcome& outcome);
  void publishState(double time);
  void publishFeedback(double time);

  sim::TrajectoryController controller_;
  ros::NodeHandle node_;  // below the controller's name
  StepSender* sender_;
  PublishSchedule state_schedule_;
  ListenedPublisher state_publisher_;
  MessagePool<JointTrajectoryControllerState> states_;
  ros::Subscriber commands_;
  ros::ServiceServer query_;
  Goals goals_;
};

}  // namespace blem_sim::node
