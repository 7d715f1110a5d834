#pragma once

#include "loop/simulation_loop.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~get_world_properties`, `~get_model_properties`, `~get_model_state`, `~get_link_state`, `~get_link_properties`,
 *  `~get_joint_properties`, `~get_physics_properties`: the state between two steps. */
class QueryServices {
 public:
  QueryServices(const ros::NodeHandle& private_node, SimulationLoop* loop);

 private:
  void addModels(const sim::Simulator& simulator);
  void addLinks(const sim::Simulator& simulator);
  void addJoints(const sim::Simulator& simulator);

  ServiceGroup services_;
};

}  // namespace blem_sim::node
