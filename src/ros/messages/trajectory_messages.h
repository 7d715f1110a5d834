// Trajectories and their tracking as ROS messages.
#pragma once

#include <blem_sim/FollowJointTrajectoryGoal.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/JointTrajectoryPoint.h>

#include <vector>

#include "blem_sim/sim/trajectory_controller.h"

namespace blem_sim::node {

sim::JointTrajectory fromMessage(const trajectory_msgs::JointTrajectory& message);
sim::TrajectoryGoal fromMessage(const FollowJointTrajectoryGoal& message);

/** Fills the three points that the action's feedback and the controller's state share. */
template <typename Message>
void setTracking(const std::vector<sim::TrackingState>& states, Message* message) {
  trajectory_msgs::JointTrajectoryPoint desired, actual, error;
  for (const sim::TrackingState& state : states) {
    desired.positions.push_back(state.desired.position);
    desired.velocities.push_back(state.desired.velocity);
    desired.accelerations.push_back(state.desired.acceleration);
    actual.positions.push_back(state.position);
    actual.velocities.push_back(state.velocity);
    error.positions.push_back(state.position_error);
    error.velocities.push_back(state.velocity_error);
  }
  message->desired = desired;
  message->actual = actual;
  message->error = error;
}

}  // namespace blem_sim::node
