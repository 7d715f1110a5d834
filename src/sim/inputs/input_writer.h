// Calls as inputs.
#pragma once

#include <string>
#include <utility>

#include "blem_sim/sim/simulator_input.h"
#include "inputs/field_visitor.h"
#include "inputs/input_fields.h"

namespace blem_sim::sim {

class InputWriter : public FieldVisitor<InputWriter> {
 public:
  explicit InputWriter(const char* call) { input_.call = call; }
  SimulatorInput take() { return std::move(input_); }

  void number(const double* value) { input_.numbers.push_back(*value); }
  void integer(const int* value, int = 0, int = 0) { input_.numbers.push_back(*value); }
  void text(const std::string* value) { input_.texts.push_back(*value); }
  void check(const Pose&) {}
  std::size_t count(std::size_t size) {
    input_.numbers.push_back(static_cast<double>(size));
    return size;
  }

 private:
  SimulatorInput input_;
};

/** A call with its arguments, which are copied. */
template <typename... Arguments>
SimulatorInput inputOf(const char* call, Arguments... arguments) {
  InputWriter writer(call);
  if constexpr (sizeof...(Arguments) > 0) writer(arguments...);
  return writer.take();
}

}  // namespace blem_sim::sim
