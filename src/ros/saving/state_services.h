#pragma once

#include "loop/simulation_loop.h"
#include "saving/service_files.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~save_state`, `~restore_state`, of files below the folders that services may use. */
class StateServices {
 public:
  /** @param files that the services may read and write */
  StateServices(const ros::NodeHandle& private_node, SimulationLoop* loop, const ServiceFiles& files);

 private:
  ServiceGroup services_;
};

}  // namespace blem_sim::node
