#include "messages/trajectory_messages.h"

#include <utility>

namespace blem_sim {

namespace {

std::vector<GoalTolerance> fromMessages(const std::vector<JointTolerance>& messages) {
  std::vector<GoalTolerance> tolerances;
  for (const JointTolerance& message : messages) tolerances.push_back({message.name, message.position, message.velocity});
  return tolerances;
}

}  // namespace

JointTrajectory fromMessage(const trajectory_msgs::JointTrajectory& message) {
  JointTrajectory trajectory;
  trajectory.joints = message.joint_names;
  trajectory.start_time = message.header.stamp.toSec();
  for (const trajectory_msgs::JointTrajectoryPoint& point : message.points) {
    TrajectoryPoint knot;
    knot.time_from_start = point.time_from_start.toSec();
    knot.positions = point.positions;
    knot.velocities = point.velocities;
    knot.accelerations = point.accelerations;
    knot.effort = point.effort;
    trajectory.points.push_back(std::move(knot));
  }
  return trajectory;
}

TrajectoryGoal fromMessage(const FollowJointTrajectoryGoal& message) {
  return {fromMessage(message.trajectory), fromMessages(message.path_tolerance), fromMessages(message.goal_tolerance),
          message.goal_time_tolerance.toSec()};
}

}  // namespace blem_sim
