// A group of joints that follows trajectories, with joint_trajectory_controller's semantics, without ROS.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blem_sim/sim/controller_config.h"
#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

/** Codes of control_msgs/FollowJointTrajectory. */
enum class GoalError { SUCCESSFUL = 0, INVALID_GOAL = -1, INVALID_JOINTS = -2, PATH_TOLERANCE_VIOLATED = -4, GOAL_TOLERANCE_VIOLATED = -5 };

/** A command that a controller does not take; nothing has changed. */
class GoalRefused : public InputError {
 public:
  GoalRefused(GoalError code, const std::string& text) : InputError(text), error(code) {}
  const GoalError error;
};

/** Errors that a goal allows a joint. 0: the controller's own, negative: any. */
struct GoalTolerance {
  std::string joint;
  double position = 0;  ///< [rad or m]
  double velocity = 0;  ///< [rad/s or m/s]
};

struct TrajectoryGoal {
  JointTrajectory trajectory;
  std::vector<GoalTolerance> path_tolerance, goal_tolerance;
  double goal_time_tolerance = 0;  ///< [s]; 0: the controller's own, negative: none
};

enum class GoalEnd { SUCCEEDED, ABORTED, PREEMPTED };

/** Outcome of a goal. */
struct GoalOutcome {
  GoalEnd end = GoalEnd::SUCCEEDED;
  GoalError error = GoalError::SUCCESSFUL;
  std::string text;  ///< which joint failed by how much; empty for a success
};

/** State of a controlled joint. */
struct TrackingState {
  JointSample desired;
  double position = 0, velocity = 0;              ///< actual [rad or m, rad/s or m/s]
  double position_error = 0, velocity_error = 0;  ///< desired less actual; of a continuous joint the shorter way round
};

/** Tolerances of a joint in force; 0: any error is allowed. */
struct TrackingTolerance {
  double path_position = 0, path_velocity = 0, goal_position = 0, goal_velocity = 0;  ///< [rad or m, rad/s or m/s]
};

/**
 * Takes trajectories for its joints between two steps, and judges after each step how a goal is followed. Bad input throws and changes
 * nothing. Trajectories start with the next step at the earliest: points at or before it are old and left out.
 */
class TrajectoryController {
 public:
  /** @throws InputError: a joint is unknown or moved by another one (mimic), a constraint is for none of the joints */
  TrajectoryController(Simulator* simulator, int robot, ControllerConfig config);

  const ControllerConfig& config() const { return config_; }
  const std::vector<std::string>& joints() const { return joint_names_; }

  /** A controller takes commands while it runs: not before its start. */
  bool running() const { return running_; }
  /** Holds the joints where they are. */
  void start();
  /** Ends a goal and holds the joints' desired positions. */
  void stop();

  /** Follows a trajectory (no points: stops), which ends a goal. @return number of points left out as old @throws GoalRefused, InputError
   */
  int command(const JointTrajectory& trajectory);
  /** The same with an outcome, which update() tells. @throws GoalRefused */
  int accept(const TrajectoryGoal& goal);
  /** Stops, and ends the goal. */
  void cancel();
  /** Ends the goal; the motion goes on. */
  void dropGoal() { goal_.reset(); }
  bool hasGoal() const { return goal_.has_value(); }

  /** To be called after each step. @return outcome of the goal if it has ended */
  std::optional<GoalOutcome> update();

  /** States of joints() now. */
  std::vector<TrackingState> state() const;
  /** Desired states of joints() at a time [s]. @throws InputError: the controller is stopped, or the path in force begins later */
  std::vector<JointSample> query(double time) const;

 private:
  int robot() const;  ///< @throws InputError: it was removed
  const RobotInfo& robotInfo() const { return simulator_->robots()[robot()]; }
  /** A joint on its way to a goal. */
  struct GoalJoint {
    int joint = 0;                ///< index into joints()
    JointSpline::Knot last;       ///< of its path: another one means that the path was replaced
    TrackingTolerance tolerance;  ///< in force
    bool reached = false;         ///< it was within its goal tolerances once
  };
  struct Goal {
    double start = 0, end = 0;  ///< [s]
    double goal_time = 0;       ///< [s] after the end
    std::vector<GoalJoint> joints;
  };
  /** A command that is about to be obeyed: without its old points, its start not before the next step. */
  struct Plan {
    JointTrajectory trajectory;
    double start = 0, end = 0;  ///< [s]
    int old_points = 0;
  };

  int indexOf(const std::string& joint) const;
  void checkRunning() const;
  /** @param field that names the joint, for the refusal */
  void checkJoint(const char* field, const std::string& joint) const;
  void checkJoints(const JointTrajectory& trajectory) const;
  Plan planFor(const JointTrajectory& trajectory) const;
  void follow(const Plan& plan);
  /** Brings the joints to rest. @return when they are meant to be [s] */
  double halt();

  TrackingTolerance ownTolerance(int joint) const;
  void checkTolerances(const TrajectoryGoal& goal) const;
  Goal goalFor(const TrajectoryGoal& goal, const Plan& plan) const;
  Goal goalToHalt(double end) const;
  GoalJoint goalJoint(int joint) const;

  TrackingState stateAt(int joint, double time) const;
  bool replaced(const GoalJoint& joint) const;
  /** Checks one joint of the goal. @return how the goal fails, if it does */
  std::optional<GoalOutcome> judge(GoalJoint* joint, double time) const;

  Simulator* simulator_;
  std::string robot_;  ///< its index may change when others come or go
  ControllerConfig config_;
  std::vector<int> joints_;  ///< indices into RobotInfo::joint_names
  std::vector<std::string> joint_names_;
  bool running_ = false;
  std::optional<Goal> goal_;
};

}  // namespace blem_sim::sim
