// All steppers, by name.
#pragma once

#include <memory>
#include <vector>

#include "scene/stepper.h"

namespace blem_sim::dynamics {

struct StepperRow {
  const char* name;
  std::unique_ptr<Stepper> (*make)(const SolverSettings& settings);
};

const std::vector<StepperRow>& stepperTable();

/** Throws InputError for a name that is not in the table. */
std::unique_ptr<Stepper> makeStepper(const SolverSettings& settings);

}  // namespace blem_sim::dynamics
