#pragma once

#include <blem_sim/LoadEnvironment.h>
#include <blem_sim/UnloadEnvironment.h>
#include <ros/node_handle.h>

#include "loop/simulation_loop.h"

namespace blem_sim {

/** `~load_environment`, `~unload_environment`. A request that cannot be met changes nothing; status_message gives the reason. */
class EnvironmentServices {
 public:
  EnvironmentServices(ros::NodeHandle private_node, SimulationLoop* loop);

 private:
  bool onLoad(LoadEnvironment::Request& request, LoadEnvironment::Response& response);
  bool onUnload(UnloadEnvironment::Request& request, UnloadEnvironment::Response& response);

  SimulationLoop* loop_;
  ros::ServiceServer load_, unload_;
};

}  // namespace blem_sim
