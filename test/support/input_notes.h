// Inputs that a simulation told, to be given to a fresh one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

/** Inputs with the steps made before them, and the hash after every step. */
class InputNotes : public SimulatorWatcher {
 public:
  explicit InputNotes(Simulator* simulator) : simulator_(simulator) { simulator->watch(this); }
  ~InputNotes() override { simulator_->watch(nullptr); }
  void told(const SimulatorInput& input) override { inputs.emplace_back(hashes.size(), input); }
  void stepped() override { hashes.push_back(simulator_->stateHash()); }

  std::vector<std::pair<std::size_t, SimulatorInput>> inputs;
  std::vector<std::uint64_t> hashes;

 private:
  Simulator* simulator_;
};

/** Step of the first hash that is another, counted from 1; 0 if there is none. */
inline std::size_t firstDifference(const SimulationConfig& config, const InputNotes& notes) {
  Simulator simulator(config, model::UriResolver());
  std::size_t next = 0;
  for (std::size_t step = 0; step < notes.hashes.size(); ++step) {
    for (; next < notes.inputs.size() && notes.inputs[next].first == step; ++next) applyInput(notes.inputs[next].second, &simulator);
    simulator.step();
    if (simulator.stateHash() != notes.hashes[step]) return step + 1;
  }
  return 0;
}

}  // namespace blem_sim::sim
