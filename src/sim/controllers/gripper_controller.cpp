#include "blem_sim/sim/gripper_controller.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "controllers/controlled_joints.h"
#include "numbers/nearest_turn.h"

namespace blem_sim::sim {
namespace {

int onlyJoint(const RobotInfo& robot, const ControllerConfig& config) {
  if (config.joints.size() != 1)
    throw InputError(fmt::format("controller '{}': joint: is missing; name the joint that the gripper's motor moves", config.name));
  return controlledJoints(robot, config).front();
}

}  // namespace

int GripperController::robot() const { return controlledRobot(*simulator_, config_, robot_); }

GripperController::GripperController(Simulator* simulator, int robot, ControllerConfig config)
    : simulator_(simulator),
      robot_(simulator->robots().at(robot).name),
      config_(std::move(config)),
      joint_(onlyJoint(simulator->robots().at(robot), config_)) {}

void GripperController::start() {
  running_ = true;
  simulator_->holdJoints(robot(), {joint_});
}

void GripperController::stop() {
  running_ = false;
  goal_.reset();
}

void GripperController::accept(double position) {
  if (!running_)
    throw GoalRefused(GoalError::INVALID_GOAL, fmt::format("controller '{}' is stopped; start it by switch_controller", config_.name));
  if (!isCommand(position))
    throw GoalRefused(GoalError::INVALID_GOAL,
                      fmt::format("command: position: is not a finite number within {:g}; correct it", LARGEST_COMMAND));
  simulator_->holdJoint(robot(), joint_, position);
  stalled_ = reached_ = false;
  goal_ = Goal{position, simulator_->time(), simulator_->followedPath(robot(), joint_)->lastKnot()};
}

void GripperController::cancel() {
  if (!goal_) return;
  goal_.reset();
  simulator_->holdJoints(robot(), {joint_});
}

std::optional<GoalOutcome> GripperController::update() {
  if (!goal_) return {};
  const dynamics::JointState now = joint();
  const double error = errorFrom(now.position), time = simulator_->time();
  if (replaced()) return end(GoalEnd::PREEMPTED, "the joint got another command or was reset");
  reached_ = std::abs(error) < config_.goal_tolerance;
  if (reached_) return end(GoalEnd::SUCCEEDED, "");
  if (std::abs(now.velocity) > config_.stall_velocity_threshold) goal_->moved_last = time;
  stalled_ = time - goal_->moved_last > config_.stall_timeout;
  if (!stalled_) return {};
  return end(GoalEnd::ABORTED, fmt::format("stalled at {:.6g}, {:.6g} short of the goal", now.position, std::abs(error)));
}

GripperState GripperController::state() const {
  const dynamics::JointState now = joint();
  return {now.position, now.effort, stalled_, reached_};
}

dynamics::JointState GripperController::joint() const { return simulator_->world().jointState(robotInfo().joints[joint_]); }

double GripperController::errorFrom(double position) const {
  const bool continuous = robotInfo().continuous[joint_];
  return continuous ? shortestTurn(position, goal_->position) : goal_->position - position;
}

bool GripperController::replaced() const {
  const JointSpline* path = simulator_->followedPath(robot(), joint_);
  return !path || !sameKnot(path->lastKnot(), goal_->last);
}

GoalOutcome GripperController::end(GoalEnd end, const std::string& text) {
  goal_.reset();
  return {end, GoalError::SUCCESSFUL, text};
}

}  // namespace blem_sim::sim
