#include "saving/record_bag.h"

#include <yaml-cpp/yaml.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/config.h"
#include "blem_sim/sim/state_file.h"

namespace blem_sim::node {

namespace {

constexpr std::size_t NUMBERS_PER_GAIN = 4;

RecordedRobot robotMessage(const sim::RobotConfig& robot) {
  RecordedRobot message;
  message.description = robot.urdf_xml;
  for (const auto& [joint, gains] : robot.pid_gains) {
    message.gains_joints.push_back(joint);
    message.gains.insert(message.gains.end(), {gains.p, gains.i, gains.d, gains.i_clamp});
  }
  return message;
}

void addTo(sim::RobotConfig* robot, const RecordedRobot& message, const std::string& source) {
  if (message.gains.size() != NUMBERS_PER_GAIN * message.gains_joints.size())
    throw InputError(source + ": start: gains are not four for each joint; record it again");
  robot->urdf_xml = message.description;
  for (std::size_t i = 0; i < message.gains_joints.size(); ++i) {
    const double* gains = message.gains.data() + NUMBERS_PER_GAIN * i;
    robot->pid_gains[message.gains_joints[i]] = {gains[0], gains[1], gains[2], gains[3]};
  }
}

YAML::Node documentOf(const std::string& text, const std::string& source) {
  try {
    return sim::loadYaml(text);
  } catch (const YAML::Exception& error) {
    throw InputError(source + ": start: the configuration is no YAML: " + error.what() + "; record it again");
  }
}

}  // namespace

RecordStart startMessage(const sim::Simulator& simulator, const std::string& configuration) {
  RecordStart start;
  start.format = RecordStart::FORMAT;
  start.configuration = configuration;
  start.base_directory = simulator.config().base_directory;
  for (const sim::RobotConfig& robot : simulator.config().robots) start.robots.push_back(robotMessage(robot));
  const std::string state = sim::stateBytes(simulator.save());
  start.state.assign(state.begin(), state.end());
  return start;
}

sim::SimulationConfig configOf(const RecordStart& start, const std::string& source) {
  if (start.format != RecordStart::FORMAT)
    throw InputError(source + ": is of format " + std::to_string(start.format) + ", this version replays " +
                     std::to_string(RecordStart::FORMAT) + "; replay it with the version that recorded it");
  sim::SimulationConfig config =
      sim::parseConfig(documentOf(start.configuration, source), source + ": configuration", start.base_directory);
  if (config.robots.size() != start.robots.size())
    throw InputError(source + ": start: " + std::to_string(start.robots.size()) + " robots of " + std::to_string(config.robots.size()) +
                     "; record it again");
  for (std::size_t i = 0; i < config.robots.size(); ++i) addTo(&config.robots[i], start.robots[i], source);
  return config;
}

RecordedInput toMessage(const sim::SimulatorInput& input, std::uint64_t step) {
  RecordedInput message;
  message.step = step;
  message.call = input.call;
  message.texts = input.texts;
  message.numbers = input.numbers;
  message.state.assign(input.state.begin(), input.state.end());
  return message;
}

sim::SimulatorInput fromMessage(const RecordedInput& message) {
  return {message.call, message.texts, message.numbers, std::string(message.state.begin(), message.state.end())};
}

}  // namespace blem_sim::node
