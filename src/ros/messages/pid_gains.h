// Gains as users of gazebo_ros_control have them on the parameter server.
#pragma once

#include <map>
#include <string>

#include "blem_sim/sim/config.h"

namespace blem_sim::node {

/** Gains by joint of the parameter `gazebo_ros_control/pid_gains` in a robot's namespace; none if it is not set. @throws InputError */
std::map<std::string, sim::JointGains> pidGainsIn(const std::string& name_space);

}  // namespace blem_sim::node
