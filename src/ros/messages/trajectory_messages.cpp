#include "messages/trajectory_messages.h"

#include <utility>

namespace blem_sim::node {

namespace {

std::vector<sim::GoalTolerance> fromMessages(const std::vector<JointTolerance>& messages) {
  std::vector<sim::GoalTolerance> tolerances;
  for (const JointTolerance& message : messages) tolerances.push_back({message.name, message.position, message.velocity});
  return tolerances;
}

}  // namespace

sim::JointTrajectory fromMessage(const trajectory_msgs::JointTrajectory& message) {
  sim::JointTrajectory trajectory;
  trajectory.joints = message.joint_names;
  trajectory.start_time = message.header.stamp.toSec();
  for (const trajectory_msgs::JointTrajectoryPoint& point : message.points) {
    sim::TrajectoryPoint knot;
    knot.time_from_start = point.time_from_start.toSec();
    knot.positions = point.positions;
    knot.velocities = point.velocities;
    knot.accelerations = point.accelerations;
    knot.effort = point.effort;
    trajectory.points.push_back(std::move(knot));
  }
  return trajectory;
}

sim::TrajectoryGoal fromMessage(const FollowJointTrajectoryGoal& message) {
  return {fromMessage(message.trajectory), fromMessages(message.path_tolerance), fromMessages(message.goal_tolerance),
          message.goal_time_tolerance.toSec()};
}

}  // namespace blem_sim::node
