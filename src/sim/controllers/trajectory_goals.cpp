// Goals of a controller: tolerances, and whether the joints keep them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/sim/trajectory_controller.h"
#include "numbers/nearest_turn.h"

namespace blem_sim::sim {
namespace {

// A step's time and a trajectory's end are sums of their own, so that one instant has several numbers.
constexpr double SAME_INSTANT = 1e-9;  // [s]

bool exceeds(double error, double tolerance) { return tolerance > 0 && std::abs(error) > tolerance; }

/** A goal's tolerance over the controller's own. */
void takeOver(double asked, double* tolerance) {
  if (asked != 0) *tolerance = std::max(asked, 0.0);
}

void checkFinite(const char* field, const std::vector<GoalTolerance>& tolerances) {
  for (const GoalTolerance& tolerance : tolerances)
    if (!std::isfinite(tolerance.position) || !std::isfinite(tolerance.velocity))
      throw GoalRefused(GoalError::INVALID_GOAL,
                        fmt::format("{}: joint '{}' has a number that is not finite; 0 means the controller's own tolerance, a negative "
                                    "one none",
                                    field, tolerance.joint));
}

/** Takes the tolerances of a joint over those in force. */
void takeOver(const std::string& joint, const std::vector<GoalTolerance>& asked, double* position, double* velocity) {
  for (const GoalTolerance& tolerance : asked) {
    if (tolerance.joint != joint) continue;
    takeOver(tolerance.position, position);
    takeOver(tolerance.velocity, velocity);
  }
}

/** How a joint fails, in words; empty if it does not. */
std::string excess(const TrackingState& state, double position_tolerance, double velocity_tolerance) {
  if (exceeds(state.position_error, position_tolerance))
    return fmt::format("position error {:.6g}, tolerance {:.6g}", state.position_error, position_tolerance);
  if (exceeds(state.velocity_error, velocity_tolerance))
    return fmt::format("velocity error {:.6g}, tolerance {:.6g}", state.velocity_error, velocity_tolerance);
  return "";
}

}  // namespace

TrackingTolerance TrajectoryController::ownTolerance(int joint) const {
  TrackingTolerance tolerance;
  tolerance.goal_velocity = config_.stopped_velocity_tolerance;
  const auto constraint = config_.joint_constraints.find(joint_names_[joint]);
  if (constraint == config_.joint_constraints.end()) return tolerance;
  tolerance.path_position = constraint->second.trajectory;
  tolerance.goal_position = constraint->second.goal;
  return tolerance;
}

void TrajectoryController::checkTolerances(const TrajectoryGoal& goal) const {
  for (const GoalTolerance& tolerance : goal.path_tolerance) checkJoint("path_tolerance", tolerance.joint);
  for (const GoalTolerance& tolerance : goal.goal_tolerance) checkJoint("goal_tolerance", tolerance.joint);
  checkFinite("path_tolerance", goal.path_tolerance);
  checkFinite("goal_tolerance", goal.goal_tolerance);
}

TrajectoryController::GoalJoint TrajectoryController::goalJoint(int joint) const {
  return {joint, simulator_->followedPath(robot(), joints_[joint])->lastKnot(), {}, false};
}

TrajectoryController::Goal TrajectoryController::goalToHalt(double end) const {
  Goal goal{simulator_->time(), end, 0, {}};
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) goal.joints.push_back(goalJoint(static_cast<int>(joint)));
  return goal;
}

TrajectoryController::Goal TrajectoryController::goalFor(const TrajectoryGoal& asked, const Plan& plan) const {
  Goal goal{plan.start, plan.end, config_.goal_time, {}};
  takeOver(asked.goal_time_tolerance, &goal.goal_time);
  for (const std::string& name : plan.trajectory.joints) {
    GoalJoint joint = goalJoint(indexOf(name));
    joint.tolerance = ownTolerance(joint.joint);
    takeOver(name, asked.path_tolerance, &joint.tolerance.path_position, &joint.tolerance.path_velocity);
    takeOver(name, asked.goal_tolerance, &joint.tolerance.goal_position, &joint.tolerance.goal_velocity);
    goal.joints.push_back(joint);
  }
  return goal;
}

TrackingState TrajectoryController::stateAt(int joint, double time) const {
  const RobotInfo& info = robotInfo();
  const dynamics::JointState actual = simulator_->world().jointState(info.joints[joints_[joint]]);
  TrackingState state{simulator_->desiredState(robot(), joints_[joint], time), actual.position, actual.velocity, 0, 0};
  const double desired = state.desired.position;
  state.position_error = info.continuous[joints_[joint]] ? shortestTurn(actual.position, desired) : desired - actual.position;
  state.velocity_error = state.desired.velocity - actual.velocity;
  return state;
}

std::vector<TrackingState> TrajectoryController::state() const {
  std::vector<TrackingState> states;
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) states.push_back(stateAt(static_cast<int>(joint), simulator_->time()));
  return states;
}

std::vector<JointSample> TrajectoryController::query(double time) const {
  checkRunning();
  std::vector<JointSample> samples;
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    const JointSpline* path = simulator_->followedPath(robot(), joints_[joint]);
    if (path && time < path->startTime() - SAME_INSTANT)
      throw InputError(fmt::format("query_state: {:.9g} s is before the path of joint '{}' begins, at {:.9g} s; ask for a later time", time,
                                   joint_names_[joint], path->startTime()));
    samples.push_back(simulator_->desiredState(robot(), joints_[joint], time));
  }
  return samples;
}

bool TrajectoryController::replaced(const GoalJoint& joint) const {
  const JointSpline* path = simulator_->followedPath(robot(), joints_[joint.joint]);
  return !path || !sameKnot(path->lastKnot(), joint.last);
}

std::optional<GoalOutcome> TrajectoryController::judge(GoalJoint* joint, double time) const {
  const bool at_end = time > goal_->end - SAME_INSTANT;
  // The end itself is judged by the trajectory's last velocity, later times by rest.
  const TrackingState state = stateAt(joint->joint, std::abs(time - goal_->end) <= SAME_INSTANT ? goal_->end : time);
  const TrackingTolerance& tolerance = joint->tolerance;
  const std::string why = at_end ? excess(state, tolerance.goal_position, tolerance.goal_velocity)
                                 : excess(state, tolerance.path_position, tolerance.path_velocity);
  joint->reached = joint->reached || (at_end && why.empty());
  if (why.empty() || (at_end && time < goal_->end + goal_->goal_time - SAME_INSTANT)) return {};
  const std::string text = fmt::format("joint '{}': {}", joint_names_[joint->joint], why);
  return at_end ? GoalOutcome{GoalEnd::ABORTED, GoalError::GOAL_TOLERANCE_VIOLATED, "goal tolerance violated: " + text}
                : GoalOutcome{GoalEnd::ABORTED, GoalError::PATH_TOLERANCE_VIOLATED, "path tolerance violated: " + text};
}

std::optional<GoalOutcome> TrajectoryController::update() {
  if (!goal_) return {};
  std::optional<GoalOutcome> outcome;
  const double time = simulator_->time();
  bool reached = true;
  for (GoalJoint& joint : goal_->joints) {
    if (replaced(joint))
      outcome = GoalOutcome{GoalEnd::PREEMPTED, GoalError::SUCCESSFUL,
                            fmt::format("joint '{}' got another command or was reset", joint_names_[joint.joint])};
    else if (time > goal_->start - SAME_INSTANT)
      outcome = judge(&joint, time);
    if (outcome) break;
    reached = reached && joint.reached;
  }
  if (!outcome && reached) outcome = GoalOutcome{};
  if (outcome) goal_.reset();
  return outcome;
}

}  // namespace blem_sim::sim
