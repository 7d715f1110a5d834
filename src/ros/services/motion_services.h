#pragma once

#include <blem_sim/LinkState.h>
#include <blem_sim/ModelState.h>
#include <blem_sim/SetModelConfiguration.h>

#include "loop/simulation_loop.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/**
 * `~set_model_state`, `~set_link_state`, each a service and a topic, `~set_model_configuration` and `~reset_model`. A model is moved as a
 * whole; a message of a topic that is refused is counted, and told in the log.
 */
class MotionServices {
 public:
  MotionServices(ros::NodeHandle private_node, SimulationLoop* loop);

 private:
  void setModelState(const ModelState& state);
  void setLinkState(const LinkState& state);
  void configure(const SetModelConfiguration::Request& request);

  sim::Simulator* simulator_;
  ServiceGroup services_;
  ros::Subscriber model_states_, link_states_;
};

}  // namespace blem_sim::node
