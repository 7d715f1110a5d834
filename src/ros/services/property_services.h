#pragma once

#include <blem_sim/SetJointProperties.h>
#include <blem_sim/SetLinkProperties.h>
#include <blem_sim/SetPhysicsProperties.h>

#include "loop/simulation_loop.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~set_physics_properties`, `~set_link_properties`, `~set_joint_properties`; status_message names what has no meaning here. */
class PropertyServices {
 public:
  PropertyServices(const ros::NodeHandle& private_node, SimulationLoop* loop);

 private:
  void setPhysics(const SetPhysicsProperties::Request& request, SetPhysicsProperties::Response* response);
  void setLink(const SetLinkProperties::Request& request);
  void setJoint(const SetJointProperties::Request& request, SetJointProperties::Response* response);

  SimulationLoop* loop_;
  ServiceGroup services_;
};

}  // namespace blem_sim::node
