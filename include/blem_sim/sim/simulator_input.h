// Inputs of a simulation as plain data: noted when they are taken, given again later.
#pragma once

#include <string>
#include <vector>

namespace blem_sim::sim {

class Simulator;

/** A call of a Simulator that changes it, between two steps: the method's name and its arguments, in order. */
struct SimulatorInput {
  std::string call;
  std::vector<std::string> texts;
  std::vector<double> numbers;
  std::string state;  ///< of restore: stateBytes
};

/** Someone who is told of all that decides the bits of a simulation. */
class SimulatorWatcher {
 public:
  virtual ~SimulatorWatcher() = default;
  /** The simulator took an input; one that it refused is not told. */
  virtual void told(const SimulatorInput& input) = 0;
  virtual void stepped() = 0;
};

/** Makes the call that an input describes. @throws InputError: no such call, arguments that are none of it, or what the call refuses */
void applyInput(const SimulatorInput& input, Simulator* simulator);

}  // namespace blem_sim::sim
