// ODE's own two steppers.
#pragma once

#include <memory>

#include "blem_sim/dynamics/world_types.h"

namespace blem_sim::dynamics {

class Stepper;

/** dWorldStep: Dantzig's pivoting on all rows at once; exact, cubic in rows. */
std::unique_ptr<Stepper> makeWorldStep(const SolverSettings& settings);

/** dWorldQuickStep: quick_step_iterations sweeps of projected relaxation in random order; fast, loose. */
std::unique_ptr<Stepper> makeQuickStep(const SolverSettings& settings);

}  // namespace blem_sim::dynamics
