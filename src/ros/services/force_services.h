#pragma once

#include <blem_sim/ApplyBodyWrench.h>
#include <blem_sim/ApplyJointEffort.h>

#include "loop/simulation_loop.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~apply_body_wrench`, `~clear_body_wrenches`, `~apply_joint_effort`, `~clear_joint_forces`. */
class ForceServices {
 public:
  ForceServices(const ros::NodeHandle& private_node, sim::Simulator* simulator);

 private:
  void applyWrench(const ApplyBodyWrench::Request& request);
  void applyEffort(const ApplyJointEffort::Request& request);

  sim::Simulator* simulator_;
  ServiceGroup services_;
};

}  // namespace blem_sim::node
