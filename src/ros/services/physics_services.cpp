#include "services/physics_services.h"

#include <std_srvs/Empty.h>

#include <functional>
#include <string>
#include <utility>

namespace blem_sim::node {

PhysicsServices::PhysicsServices(const ros::NodeHandle& private_node, SimulationLoop* loop) : services_(private_node) {
  const auto add = [this](const std::string& name, std::function<void()> act) {
    services_.add<std_srvs::Empty>(name, [act = std::move(act)](const auto&, auto*) { act(); });
  };
  add("pause_physics", [loop] { loop->pause(); });
  add("unpause_physics", [loop] { loop->unpause(); });
  add("reset_world", [loop] { loop->resetWorld(); });
  add("reset_simulation", [loop] { loop->resetSimulation(); });
}

}  // namespace blem_sim::node
