#pragma once

#include <blem_sim/DeleteModel.h>
#include <blem_sim/SpawnModel.h>

#include "loop/simulation_loop.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~spawn_urdf_model`, `~delete_model`; `~spawn_sdf_model` and the services of lights, which are not supported and say so. */
class SpawnServices {
 public:
  SpawnServices(const ros::NodeHandle& private_node, SimulationLoop* loop);

 private:
  void spawn(const SpawnModel::Request& request, SpawnModel::Response* response);
  void remove(const std::string& model);
  void addRefusals();

  SimulationLoop* loop_;
  ServiceGroup services_;
};

}  // namespace blem_sim::node
