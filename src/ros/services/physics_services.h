#pragma once

#include "loop/simulation_loop.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~pause_physics`, `~unpause_physics`, `~reset_world` (time goes on), `~reset_simulation` (time starts again at 0). */
class PhysicsServices {
 public:
  PhysicsServices(const ros::NodeHandle& private_node, SimulationLoop* loop);

 private:
  ServiceGroup services_;
};

}  // namespace blem_sim::node
