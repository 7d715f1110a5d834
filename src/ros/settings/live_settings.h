// The simulation's settings that can be changed while it runs.
#pragma once

#include "loop/simulation_loop.h"
#include "settings/reconfigure_server.h"

namespace blem_sim::node {

/**
 * Offers to dynamic_reconfigure, below the node's name: gravity_x to _z, time_step, real_time_factor, MODEL::friction of each model, and
 * ROBOT::JOINT::p, ::i and ::d of each joint with a motor of its own. Changes act between steps, as those of services do.
 */
class LiveSettings {
 public:
  LiveSettings(const ros::NodeHandle& private_node, SimulationLoop* loop);

 private:
  void modelsChanged();
  void addPhysics(std::vector<Setting>* settings) const;
  void addFriction(std::vector<Setting>* settings) const;
  void addGains(std::vector<Setting>* settings) const;

  SimulationLoop* loop_;
  ReconfigureServer server_;
};

}  // namespace blem_sim::node
