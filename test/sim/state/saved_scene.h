// A scene with something of every kind of state, and its words one by one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {

/** A motor with an integral on its way along a trajectory, sensors with noise and drift; cubes that rest, bounce, and sit on a layer's
 * stop; a plate that crosses the ground, and so is outside its layer and led back. */
inline SimulationConfig sceneOfAllKinds(const std::string& stepper = "articulated") {
  SimulationConfig config;
  config.solver.stepper = stepper;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.0526}), box("ball", Vector3::Constant(0.05), 0.2, {0.5, 0, 0.08}),
                    box("heavy", Vector3::Constant(0.1), 40, {-0.5, 0, 0.0525}), box("plate", {0.1, 0.1, 0.06}, 1, {0, 0.5, 0})};
  config.objects[1].contact.restitution = 0.7;
  config.objects[1].linear_velocity = {0.3, 0, -2};
  config.objects[2].contact.stiffness = 1e3;
  config.objects[2].contact.damping = 50;
  RobotConfig pendulum = robot("pendulum", pendulumUrdf(), true);
  pendulum.X_WR = makePose({1, 0, 0});
  pendulum.gains["default"] = {100, 20, 5, 50};
  SensorConfig imu;
  imu.name = "imu";
  imu.link = "arm";
  imu.noise[0].stddev = imu.noise[0].bias_stddev = 0.1;
  SensorConfig wrench;
  wrench.name = "wrench";
  wrench.type = SensorType::FORCE_TORQUE;
  wrench.joint = "hinge";
  for (QuantityNoise& noise : wrench.noise) noise.stddev = 0.1;
  pendulum.sensors = {imu, wrench};
  config.robots = {pendulum};
  return config;
}

/** Brings the simulation on its way: 60 ms after a trajectory was given. */
inline void setOut(Simulator* simulator) {
  JointTrajectory trajectory;
  trajectory.joints = {"hinge"};
  trajectory.points = {{0.04, {0.2}, {1}, {}, {}}, {0.2, {0.5}, {0}, {}, {}}};
  simulator->commandTrajectory(0, trajectory);
  stepFor(simulator, 0.06);
}

inline std::uint64_t bitsOf(double number) {
  std::uint64_t bits;
  std::memcpy(&bits, &number, sizeof bits);
  return bits;
}

inline double numberOf(std::uint64_t bits) {
  double number;
  std::memcpy(&number, &bits, sizeof number);
  return number;
}

/** Header and content of a state, as words; not the text of its layout. */
inline std::vector<std::uint64_t> wordsOf(const SimulationState& state) {
  const StateHeader& header = state.header;
  std::vector<std::uint64_t> words = {header.format, header.layout, header.length, header.checksum, state.step};
  for (const auto* numbers : {&state.world.numbers, &state.numbers})
    for (const double number : *numbers) words.push_back(bitsOf(number));
  for (const auto* list : {&state.world.words, &state.words}) words.insert(words.end(), list->begin(), list->end());
  return words;
}

constexpr std::size_t HEADER_WORDS = 4;

/** The state with another word at a place of wordsOf. */
inline SimulationState withWord(SimulationState state, std::size_t place, std::uint64_t word) {
  StateHeader& header = state.header;
  for (std::uint64_t* at : {&header.format, &header.layout, &header.length, &header.checksum, &state.step}) {
    if (place-- > 0) continue;
    *at = word;
    return state;
  }
  for (auto* numbers : {&state.world.numbers, &state.numbers}) {
    if (place < numbers->size()) {
      (*numbers)[place] = numberOf(word);
      return state;
    }
    place -= numbers->size();
  }
  for (auto* list : {&state.world.words, &state.words}) {
    if (place < list->size()) {
      (*list)[place] = word;
      return state;
    }
    place -= list->size();
  }
  ADD_FAILURE() << "no such word";
  return state;
}

/** Words to put in the place of another: small and huge counts, flipped bits, numbers that are none, infinite or absurd. */
inline std::vector<std::uint64_t> otherWords(std::uint64_t word) {
  std::vector<std::uint64_t> others = {0, 1, ~word, word + 1, std::uint64_t{1} << 40};
  for (const int bit : {0, 31, 52, 63}) others.push_back(word ^ (std::uint64_t{1} << bit));
  for (const double number : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, 1e-300, -1.0}) others.push_back(bitsOf(number));
  others.erase(std::remove(others.begin(), others.end(), word), others.end());
  return others;
}

}  // namespace blem_sim::sim
