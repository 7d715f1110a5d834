#include "stepper_table.h"

#include "articulated_stepper.h"
#include "blem_sim/geometry/input_error.h"
#include "ode/ode_stepper.h"

namespace blem_sim::dynamics {

const std::vector<StepperRow>& stepperTable() {
  static const std::vector<StepperRow> table = {
      {"world_step", makeWorldStep},
      {"quick_step", makeQuickStep},
      {"articulated", makeArticulated},
  };
  return table;
}

std::unique_ptr<Stepper> makeStepper(const SolverSettings& settings) {
  std::string names;
  for (const StepperRow& row : stepperTable()) {
    if (settings.stepper == row.name) return row.make(settings);
    names += names.empty() ? row.name : std::string(", ") + row.name;
  }
  throw InputError("solver.stepper: '" + settings.stepper + "' is not a stepper; take one of " + names);
}

std::vector<std::string> stepperNames() {
  std::vector<std::string> names;
  for (const StepperRow& row : stepperTable()) names.push_back(row.name);
  return names;
}

}  // namespace blem_sim::dynamics
