#pragma once

#include "blem_sim/sim/simulator.h"
#include "services/door/service_group.h"

namespace blem_sim::node {

/** `~attach` and `~detach`: models welded to links. */
class AttachmentServices {
 public:
  AttachmentServices(const ros::NodeHandle& private_node, sim::Simulator* simulator);

 private:
  ServiceGroup services_;
};

}  // namespace blem_sim::node
