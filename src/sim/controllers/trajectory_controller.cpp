// Commands to a controller; trajectory_goals.cpp has how goals are judged.
#include "blem_sim/sim/trajectory_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "controllers/controlled_joints.h"
#include "numbers/nearest_name.h"

namespace blem_sim::sim {
namespace {

// Messages count in nanoseconds: times that are no further apart are the same.
constexpr double SAME_TIME = 1e-9;  // [s]

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/** @param first [s] earliest time of a point */
[[noreturn]] void refuseOld(double last, double first) {
  throw GoalRefused(GoalError::INVALID_GOAL,
                    fmt::format("trajectory: all points lie before the next step or the trajectory's start, the last by {:.6g} s; date "
                                "them later, or set the header's stamp to 0, which means now",
                                first - last));
}

}  // namespace

int TrajectoryController::robot() const { return controlledRobot(*simulator_, config_, robot_); }

TrajectoryController::TrajectoryController(Simulator* simulator, int robot, ControllerConfig config)
    : simulator_(simulator),
      robot_(simulator->robots().at(robot).name),
      config_(std::move(config)),
      joints_(controlledJoints(simulator->robots().at(robot), config_)) {
  for (const int joint : joints_) joint_names_.push_back(simulator->robots()[robot].joint_names[joint]);
  for (const auto& [joint, constraint] : config_.joint_constraints)
    requireName(joint, joint_names_, "controller '" + config_.name + "': constraints", "joint of this controller");
}

int TrajectoryController::indexOf(const std::string& joint) const {
  return static_cast<int>(std::find(joint_names_.begin(), joint_names_.end(), joint) - joint_names_.begin());
}

void TrajectoryController::start() {
  running_ = true;
  simulator_->holdJoints(robot(), joints_);
}

void TrajectoryController::stop() {
  if (!running_) return;
  running_ = false;
  goal_.reset();
  simulator_->commandTrajectory(robot(), {joint_names_, 0, {}});
}

void TrajectoryController::checkRunning() const {
  if (!running_)
    throw GoalRefused(GoalError::INVALID_GOAL, fmt::format("controller '{}' is stopped; start it by switch_controller", config_.name));
}

void TrajectoryController::checkJoint(const char* field, const std::string& joint) const {
  if (!contains(joint_names_, joint))
    throw GoalRefused(GoalError::INVALID_JOINTS, fmt::format("{}: '{}' is no joint of this controller; the nearest is '{}'", field,
                                                             shownName(joint), nearestName(joint, joint_names_)));
}

void TrajectoryController::checkJoints(const JointTrajectory& trajectory) const {
  const auto refuse = [](const std::string& why) { throw GoalRefused(GoalError::INVALID_JOINTS, "trajectory: joint_names: " + why); };
  if (trajectory.joints.empty()) refuse("there are none; name the controller's joints");
  for (const std::string& joint : trajectory.joints) {
    checkJoint("trajectory: joint_names", joint);
    if (std::count(trajectory.joints.begin(), trajectory.joints.end(), joint) > 1)
      refuse("'" + shownName(joint) + "' is there twice; name it once");
  }
  if (config_.allow_partial_joints_goal) return;
  for (const std::string& joint : joint_names_)
    if (!contains(trajectory.joints, joint))
      refuse(fmt::format("'{}' is missing; name all {} joints of the controller, or set allow_partial_joints_goal", joint,
                         joint_names_.size()));
}

int TrajectoryController::command(const JointTrajectory& trajectory) {
  checkRunning();
  if (trajectory.points.empty()) {
    goal_.reset();
    halt();
    return 0;
  }
  checkJoints(trajectory);
  const Plan plan = planFor(trajectory);
  follow(plan);
  goal_.reset();
  return plan.old_points;
}

int TrajectoryController::accept(const TrajectoryGoal& goal) {
  checkRunning();
  checkJoints(goal.trajectory);
  checkTolerances(goal);
  if (goal.trajectory.points.empty()) {
    goal_ = goalToHalt(halt());
    return 0;
  }
  const Plan plan = planFor(goal.trajectory);
  follow(plan);
  goal_ = goalFor(goal, plan);
  return plan.old_points;
}

void TrajectoryController::cancel() {
  if (!goal_) return;
  goal_.reset();
  halt();
}

TrajectoryController::Plan TrajectoryController::planFor(const JointTrajectory& trajectory) const {
  try {
    checkTrajectory(trajectory, joint_names_);
  } catch (const InputError& error) {
    throw GoalRefused(GoalError::INVALID_GOAL, error.what());
  }
  const double next = simulator_->time() + simulator_->config().time_step;
  const double start = trajectory.start_time > 0 ? trajectory.start_time : next;
  const auto is_old = [&](const TrajectoryPoint& point) {
    return point.time_from_start < 0 || start + point.time_from_start <= next + SAME_TIME;
  };
  const auto first = std::find_if_not(trajectory.points.begin(), trajectory.points.end(), is_old);
  const double last = start + trajectory.points.back().time_from_start;
  if (first == trajectory.points.end()) refuseOld(last, std::max(start, next));
  Plan plan{{trajectory.joints, std::max(start, next), {first, trajectory.points.end()}}, std::max(start, next), last, 0};
  plan.old_points = static_cast<int>(first - trajectory.points.begin());
  for (TrajectoryPoint& point : plan.trajectory.points) point.time_from_start = start + point.time_from_start - plan.start;
  return plan;
}

void TrajectoryController::follow(const Plan& plan) {
  try {
    simulator_->commandTrajectory(robot(), plan.trajectory);
  } catch (const InputError& error) {
    throw GoalRefused(GoalError::INVALID_GOAL, error.what());
  }
}

double TrajectoryController::halt() {
  const double duration = config_.stop_trajectory_duration, now = simulator_->time();
  if (duration <= 0) {
    simulator_->holdJoints(robot(), joints_);
    return now;
  }
  // Constant deceleration from the desired state: half of a cubic that comes back with the opposite velocity.
  TrajectoryPoint rest;
  rest.time_from_start = duration;
  for (const int joint : joints_) {
    const JointSample desired = simulator_->desiredState(robot(), joint);
    rest.positions.push_back(desired.position + desired.velocity * duration / 2);
    rest.velocities.push_back(0);
  }
  simulator_->commandTrajectory(robot(), {joint_names_, now, {rest}});
  return now + duration;
}

}  // namespace blem_sim::sim
