#include "run_setup.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "blem_sim/geometry/input_error.h"
#include "overrides.h"

namespace blem_sim {

namespace {

/** @throws InputError for what only a node can have */
void refuseTopics(const sim::SimulationConfig& config) {
  for (const sim::EnvironmentConfig& environment : config.environments)
    if (!environment.live.topic.empty())
      throw InputError(
          fmt::format("environments: {}: topic: {}: clouds come to blem_sim_node alone; save one as .pcd or .ply and give its uri",
                      environment.name, environment.live.topic));
}

}  // namespace

ConfigDocument readDocument(const std::string& file) {
  return {sim::loadYamlFile(file), file, std::filesystem::absolute(file).parent_path().string()};
}

sim::SimulationConfig configOf(const ConfigDocument& document, const std::vector<std::pair<std::string, std::string>>& settings) {
  YAML::Node root = document.root;
  for (const auto& [path, value] : settings) overrideSetting(&root, path, value);
  const sim::SimulationConfig config = sim::parseConfig(root, document.source, document.folder);
  refuseTopics(config);
  return config;
}

sim::SimulationConfig readConfig(const std::string& file, const std::vector<std::pair<std::string, std::string>>& settings) {
  return configOf(readDocument(file), settings);
}

void commandTrajectory(const std::string& file, sim::Simulator* simulator, std::vector<std::string>* notes) {
  const auto& robots = simulator->robots();
  if (robots.empty()) throw InputError("--trajectory: the configuration has no robot");
  std::string first_refusal;
  for (std::size_t robot = 0; robot < robots.size(); ++robot) {
    std::vector<std::string> ignored;
    try {
      const sim::JointTrajectory trajectory = sim::loadTrajectoryCsv(file, robots[robot].joint_names, &ignored);
      simulator->commandTrajectory(static_cast<int>(robot), trajectory);
    } catch (const InputError& error) {
      if (first_refusal.empty()) first_refusal = error.what();
      continue;
    }
    if (!ignored.empty())
      notes->push_back(
          fmt::format("{}: columns that are no joints of {}, ignored: {}", file, robots[robot].name, fmt::join(ignored, ", ")));
    return;
  }
  throw InputError(first_refusal);
}

}  // namespace blem_sim
