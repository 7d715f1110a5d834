#pragma once

#include <ros/node_handle.h>
#include <std_srvs/Empty.h>

#include <functional>
#include <vector>

#include "loop/simulation_loop.h"

namespace blem_sim::node {

/** `~pause_physics`, `~unpause_physics`, `~reset_world` (time goes on), `~reset_simulation` (time starts again at 0). */
class PhysicsServices {
 public:
  PhysicsServices(ros::NodeHandle private_node, SimulationLoop* loop);

 private:
  void advertise(ros::NodeHandle* node, const std::string& name, const std::function<void()>& act);

  std::vector<ros::ServiceServer> servers_;
};

}  // namespace blem_sim::node
