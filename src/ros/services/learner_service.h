#pragma once

#include <blem_sim/RobotObservation.h>
#include <blem_sim/StepWithCommands.h>

#include "loop/simulation_loop.h"
#include "services/door/latest_readings.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~step_with_commands`: joint commands, N steps in lock-step with the caller, and what is then known; one call per decision. */
class LearnerService {
 public:
  LearnerService(const ros::NodeHandle& private_node, SimulationLoop* loop);

 private:
  void command(const StepWithCommands::Request& request);
  /** Index of the robot that a command names. @throws InputError */
  int robotOf(const RobotCommand& command) const;
  void observe(StepWithCommands::Response* response) const;
  RobotObservation observationOf(int robot) const;
  ObservedSensor observationOf(const sim::SensorInfo& sensor) const;

  SimulationLoop* loop_;
  sim::Simulator& simulator_;
  LatestReadings* readings_;  // the loop's
  ServiceGroup services_;
};

}  // namespace blem_sim::node
