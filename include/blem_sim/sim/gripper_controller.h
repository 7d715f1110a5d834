// A gripper's joint that moves to a place or as far as what it holds lets it, with gripper_action_controller's semantics, without ROS.
#pragma once

#include <optional>
#include <string>

#include "blem_sim/sim/trajectory_controller.h"

namespace blem_sim::sim {

struct GripperState {
  double position = 0;  ///< [m or rad]
  double effort = 0;    ///< [N or N m] of the motor
  bool stalled = false, reached_goal = false;
};

/** Commands come between two steps. A goal succeeds within goal_tolerance, and is aborted once the joint has stood still for stall_timeout.
 */
class GripperController {
 public:
  /** @throws InputError: the joint is not one that has a motor */
  GripperController(Simulator* simulator, int robot, ControllerConfig config);

  const ControllerConfig& config() const { return config_; }

  /** Holds the joint where it is; goals are taken from now on. */
  void start();
  /** Ends a goal; the motor keeps its target. */
  void stop();

  /** Sends the joint to a position [m or rad]. @throws GoalRefused: stopped, no finite number */
  void accept(double position);
  /** Holds the joint where it is, and ends the goal. */
  void cancel();

  /** To be called after each step. @return outcome of the goal if it has ended; state() tells whether it stalled */
  std::optional<GoalOutcome> update();
  GripperState state() const;

 private:
  int robot() const;  ///< @throws InputError: it was removed
  const RobotInfo& robotInfo() const { return simulator_->robots()[robot()]; }
  struct Goal {
    double position = 0;     ///< [m or rad]
    double moved_last = 0;   ///< [s]
    JointSpline::Knot last;  ///< of its path: another one means that the path was replaced
  };

  dynamics::JointState joint() const;
  double errorFrom(double position) const;
  bool replaced() const;
  GoalOutcome end(GoalEnd end, const std::string& text);

  Simulator* simulator_;
  std::string robot_;  ///< its index may change when others come or go
  ControllerConfig config_;
  int joint_;  ///< index into RobotInfo::joint_names
  bool running_ = false;
  bool stalled_ = false, reached_ = false;  ///< by the last goal
  std::optional<Goal> goal_;
};

}  // namespace blem_sim::sim
