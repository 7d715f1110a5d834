// Whole scenes that grow in one thing alone.
#pragma once

#include "blem_sim/sim/config.h"

namespace blem_sim {

/** Cubes beside each other on one ground of two triangles, each an island of its own. */
sim::SimulationConfig cubesOnGround(int cubes);
/** Stacks of three cubes on one ground, each an island of its own. */
sim::SimulationConfig stacksOfThree(int stacks, int threads);

}  // namespace blem_sim
