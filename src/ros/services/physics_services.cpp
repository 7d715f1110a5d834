#include "services/physics_services.h"

#include <boost/function.hpp>

namespace blem_sim::node {

PhysicsServices::PhysicsServices(ros::NodeHandle private_node, SimulationLoop* loop) {
  advertise(&private_node, "pause_physics", [loop] { loop->pause(); });
  advertise(&private_node, "unpause_physics", [loop] { loop->unpause(); });
  advertise(&private_node, "reset_world", [loop] { loop->resetWorld(); });
  advertise(&private_node, "reset_simulation", [loop] { loop->resetSimulation(); });
}

void PhysicsServices::advertise(ros::NodeHandle* node, const std::string& name, const std::function<void()>& act) {
  const boost::function<bool(std_srvs::Empty::Request&, std_srvs::Empty::Response&)> callback = [act](std_srvs::Empty::Request&,
                                                                                                      std_srvs::Empty::Response&) {
    act();
    return true;
  };
  servers_.push_back(node->advertiseService<std_srvs::Empty::Request, std_srvs::Empty::Response>(name, callback));
}

}  // namespace blem_sim::node
