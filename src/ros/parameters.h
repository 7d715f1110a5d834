// The node's private parameters as a SimulationConfig.
#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "blem_sim/sim/config.h"

namespace blem_sim::node {

/** A configuration, and the text that parseConfig read it from. */
struct NodeParameters {
  sim::SimulationConfig config;
  std::string yaml;
};

/**
 * Reads every private parameter through parseConfig, so that the node and blem_sim_run take the same keys, plus the node's own:
 * `config_file` (relative files are meant against its folder), `environment` (URI of one more environment, of that name) and, if there is
 * no key `robots`, for one robot that is made then: `robot_description_file` (URDF file; else the parameter `robot_description` if it is
 * set), `robot_pose` ({xyz, rpy} of its root link) and `robot_fixed_base`. Fetches every `description_param`, and
 * `gazebo_ros_control/pid_gains` in the namespace of each robot, and `tf_prefix` there or above it for one that has none.
 * @throws InputError
 */
NodeParameters readParameters(const ros::NodeHandle& private_node);

/** Folders whose files services may read and write: the configuration's, file_roots and those of ROS_PACKAGE_PATH; none if services may
 * use no files. */
std::vector<std::string> serviceFolders(const sim::SimulationConfig& config);

/** Absolute path of the node's checkpoint: checkpoint_file, or NODE.checkpoint below ROS_HOME. */
std::string checkpointFile(const sim::SimulationConfig& config, const ros::NodeHandle& private_node);

}  // namespace blem_sim::node
