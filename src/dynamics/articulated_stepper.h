#pragma once

#include <memory>

#include "scene/stepper.h"

namespace blem_sim::dynamics {

/**
 * Newton's method in joint coordinates on the convex step problem: robots are trees, free bodies trees of one, trees that touch one island.
 * Joints are exact by construction, friction cones are true cones, motors, joint friction and limits are terms of the solve.
 */
std::unique_ptr<Stepper> makeArticulated(const SolverSettings& settings);

}  // namespace blem_sim::dynamics
