// A robot with a joint that has limits, one that turns without end and one that mimics the first, and a controller of it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/sim/trajectory_controller.h"
#include "sim/simulation_scene.h"
#include "support/input_errors.h"

namespace blem_sim::sim {

inline std::string link(const std::string& name) {
  return "<link name='" + name + "'><inertial><origin xyz='0.1 0 0'/><mass value='1'/>" +
         "<inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial></link>";
}

inline std::string joint(const std::string& name, const std::string& type, const std::string& child, const std::string& extras = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='base'/><child link='" + child + "'/><axis xyz='0 0 1'/>" +
         "<limit lower='-10' upper='10' effort='1000' velocity='100'/>" + extras + "</joint>";
}

inline SimulationConfig armScene() {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.robots = {robot("arm",
                         "<robot name='arm'><link name='base'/>" + link("a") + link("b") + link("c") + joint("swing", "revolute", "a") +
                             joint("spin", "continuous", "b") + joint("shadow", "revolute", "c", "<mimic joint='swing'/>") + "</robot>",
                         true)};
  config.robots[0].gains["default"] = {1e6, 0, 1e4};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  return config;
}

/** Points for `swing` and `spin`: {time [s], positions}. */
inline JointTrajectory path(const std::vector<std::pair<double, std::vector<double>>>& points, double start = 0) {
  JointTrajectory trajectory;
  trajectory.joints = {"swing", "spin"};
  trajectory.start_time = start;
  for (const auto& [time, positions] : points) trajectory.points.push_back({time, positions, {0, 0}, {}, {}});
  return trajectory;
}

inline TrajectoryGoal goalOf(const JointTrajectory& trajectory) { return {trajectory, {}, {}, 0}; }

class TrajectoryControllerTest : public testing::Test {
 protected:
  void make(const ControllerConfig& config = {}) {
    controller_ = std::make_unique<TrajectoryController>(&simulator_, 0, config);
    controller_->start();
  }

  /** Steps up to the goal's outcome, or for a time. */
  std::optional<GoalOutcome> outcomeWithin(double seconds) {
    for (long i = 0; i < std::lround(seconds / simulator_.config().time_step); ++i) {
      simulator_.step();
      if (const auto outcome = controller_->update()) return outcome;
    }
    return {};
  }

  GoalError refusalOf(const TrajectoryGoal& goal) {
    try {
      controller_->accept(goal);
    } catch (const GoalRefused& refusal) {
      EXPECT_TRUE(isOneLineWith(refusal.what(), {})) << refusal.what();
      return refusal.error;
    }
    return GoalError::SUCCESSFUL;
  }

  double position(int joint) const { return controller_->state()[joint].position; }
  double desired(int joint) const { return controller_->state()[joint].desired.position; }

  Simulator simulator_{armScene(), model::UriResolver()};
  std::unique_ptr<TrajectoryController> controller_;
};

}  // namespace blem_sim::sim
