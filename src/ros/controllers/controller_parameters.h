// Settings of controllers on the parameter server, where ros_controllers puts them: below the controller's name.
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "blem_sim/sim/controller_config.h"

namespace blem_sim::node {

/**
 * The keys below a controller's name over the settings given; a line tells of others (gains).
 * @param robot_node in the robot's namespace @throws InputError: a wrong type or range
 */
sim::ControllerConfig withParameters(const ros::NodeHandle& robot_node, const sim::ControllerConfig& settings);

/** The parameter `type` below a controller's name; empty if there is none. */
std::string controllerType(const ros::NodeHandle& robot_node, const std::string& name);

}  // namespace blem_sim::node
