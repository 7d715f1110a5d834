// Readers of configurations, commands, states and records, given bytes that nobody vouches for.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstring>
#include <memory>

#include "blem_sim/sim/simulator.h"
#include "blem_sim/sim/state_file.h"
#include "fuzz/model_targets.h"
#include "state/state_header.h"

namespace blem_sim {

/** A configuration as the node's parameters or a file give it; what is no YAML is yaml-cpp's to refuse. */
inline void fuzzYaml(const std::uint8_t* data, std::size_t size) {
  YAML::Node document;
  try {
    document = sim::loadYaml(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const YAML::Exception&) {
    return;
  }
  expectReadOrRefused([&] { sim::parseConfig(document, "fuzz.yaml", ""); });
}

inline void fuzzCsv(const std::uint8_t* data, std::size_t size) {
  const std::string file = fuzzFile(data, size, ".csv");
  std::vector<std::string> ignored;
  expectReadOrRefused([&] {
    sim::checkTrajectory(sim::loadTrajectoryCsv(file, {"time", "left_grip", "lift"}, &ignored), {"left_grip", "lift"});
  });
  std::filesystem::remove(file);
}

/** A world with a plane, a pendulum on it and its state at the start. */
struct FuzzedWorld {
  FuzzedWorld() : simulator(config(), model::UriResolver()), start(simulator.save()) {}
  static sim::SimulationConfig config() {
    sim::SimulationConfig config;
    sim::EnvironmentConfig plane;
    plane.name = "ground";
    plane.plane = Eigen::Vector4d(0, 0, 1, 0);
    config.environments = {plane};
    sim::RobotConfig robot;
    robot.name = "pendulum";
    robot.fixed_base = true;
    robot.urdf_xml = R"(<robot name="pendulum"><link name="base"/><link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
      <inertia ixx="0.01" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="hinge" type="revolute">
      <parent link="base"/><child link="arm"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/>
      <limit lower="-3" upper="3" effort="200" velocity="10"/></joint></robot>)";
    config.robots = {robot};
    return config;
  }
  static FuzzedWorld& instance() {
    static FuzzedWorld world;
    return world;
  }

  sim::Simulator simulator;
  sim::SimulationState start;
};

/** A saved state's bytes; header and layout are made to fit, or a checksum would refuse all of them. */
inline void fuzzState(const std::uint8_t* data, std::size_t size) {
  FuzzedWorld& world = FuzzedWorld::instance();
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  expectReadOrRefused([&] {
    sim::SimulationState state = sim::stateOf(bytes, "fuzz.state");
    state.layout = world.start.layout;
    state.header = sim::headerOf(state);
    world.simulator.restore(state);
  });
  world.simulator.step();
  world.simulator.restore(world.start);
}

/** Inputs of a record: bytes 0 and 1 choose the call and how many texts there are, the rest are numbers and then texts. */
inline void fuzzInput(const std::uint8_t* data, std::size_t size) {
  static const char* const CALLS[] = {
      "commandTrajectory", "commandJoints",     "holdJoint",       "loadEnvironment", "unloadEnvironment", "updateCloud", "removeModel",
      "moveModel",         "setJointPositions", "resetModel",      "applyLoad",       "applyEffort",       "clearLoads",  "clearEfforts",
      "setPhysics",        "setLinkInertial",   "setJointDamping", "setJointLimits",  "resetWorld",        "restore",     "spawn",
      "setMotorGains",     "setFriction",       "driveJoints",     "setLinkGravity",  "driveBase",         "releaseBase"};
  if (size < 2) return;
  sim::SimulatorInput input;
  input.call = CALLS[data[0] % (sizeof CALLS / sizeof *CALLS)];
  const std::size_t texts = data[1] % 8, numbers = (size - 2) / 8;
  for (std::size_t i = 0; i < numbers; ++i) {
    double number;
    std::memcpy(&number, data + 2 + 8 * i, sizeof number);
    input.numbers.push_back(number);
  }
  static const char* const TEXTS[] = {"hinge", "ground", "pendulum", "x", "", "live", "second", "/points"};
  for (std::size_t i = 0; i < texts; ++i) input.texts.emplace_back(TEXTS[(data[1] / 8 + i) % 8]);
  static std::unique_ptr<FuzzedWorld> world;
  if (!world) world = std::make_unique<FuzzedWorld>();
  expectReadOrRefused([&] { sim::applyInput(input, &world->simulator); });
  world->simulator.step();
  try {
    world->simulator.restore(world->start);
  } catch (const InputError&) {
    world.reset();  // models or settings are others now
  }
}

}  // namespace blem_sim
