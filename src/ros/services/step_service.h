#pragma once

#include <blem_sim/Step.h>

#include "loop/simulation_loop.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~step`: N steps in lock-step with the caller. A running simulation is paused first and stays paused. */
class StepService {
 public:
  StepService(const ros::NodeHandle& private_node, SimulationLoop* loop);

 private:
  void step(const Step::Request& request, Step::Response* response);

  SimulationLoop* loop_;
  ServiceGroup services_;
};

}  // namespace blem_sim::node
