// Line search of Newton's method: a safeguarded Newton's method in one dimension, on the slope.
#pragma once

#include "iterate/island_iterate.h"

namespace blem_sim::dynamics {

/** The step length along the direction in the space to where the objective is least; the direction's changes are set. Gradient known. */
double searchLine(const IslandAtHand& island, IslandIterate* iterate);

}  // namespace blem_sim::dynamics
