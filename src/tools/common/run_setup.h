// Start of a run without ROS: its configuration, its motion.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <utility>
#include <vector>

#include "blem_sim/sim/simulator.h"

namespace blem_sim {

/** A configuration that is not read yet. */
struct ConfigDocument {
  YAML::Node root;
  std::string source;  ///< the file, or what messages call it
  std::string folder;  ///< of relative files
};

/** @throws InputError: the file cannot be read, or is no YAML */
ConfigDocument readDocument(const std::string& file);

/**
 * Reads a configuration. @param settings key.path, value: replaced before it is read, in order
 * @throws InputError for what it is refused for, and for environments that only a node can have
 */
sim::SimulationConfig configOf(const ConfigDocument& document, const std::vector<std::pair<std::string, std::string>>& settings);
/** The same of a file. */
sim::SimulationConfig readConfig(const std::string& file, const std::vector<std::pair<std::string, std::string>>& settings);

/**
 * Commands the trajectory to the first robot that has joints of its columns.
 * @param notes is added: columns that are no joints @throws InputError: no robot takes it
 */
void commandTrajectory(const std::string& file, sim::Simulator* simulator, std::vector<std::string>* notes);

}  // namespace blem_sim
