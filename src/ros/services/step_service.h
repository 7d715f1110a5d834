#pragma once

#include <blem_sim/Step.h>
#include <ros/node_handle.h>

#include "loop/simulation_loop.h"

namespace blem_sim::node {

/** `~step`: N steps in lock-step with the caller. A running simulation is paused first and stays paused. */
class StepService {
 public:
  StepService(ros::NodeHandle private_node, SimulationLoop* loop);

 private:
  bool onStep(Step::Request& request, Step::Response& response);

  SimulationLoop* loop_;
  ros::ServiceServer server_;
};

}  // namespace blem_sim::node
