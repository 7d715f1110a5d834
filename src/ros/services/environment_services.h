#pragma once

#include "loop/simulation_loop.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~load_environment`, `~unload_environment`. A request that cannot be met changes nothing; status_message gives the reason. */
class EnvironmentServices {
 public:
  EnvironmentServices(const ros::NodeHandle& private_node, SimulationLoop* loop);

 private:
  ServiceGroup services_;
};

}  // namespace blem_sim::node
