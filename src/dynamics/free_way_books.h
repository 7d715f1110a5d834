// Free ways of fast trees in the result of a solve: for those who book energy, and for motors.
#pragma once

#include "problem/solved_island.h"
#include "problem/solver_space.h"
#include "trees/forest_motion.h"

namespace blem_sim::dynamics {

/** Whether any tree goes beside the way of its mean velocity. */
bool hasFreeWays(const ForestMotion& motion);

/** First part of the result's free_ways, free_speeds, free_work and free_efforts, which were set to zero. After the solve, before the
 * island's trees move. */
void bookBeforeWay(const SolvedIsland& island, const ForestMotion& motion, SolverSpace* space, SolveResult* result);

/** The other part, at the end of their way. */
void bookAfterWay(const SolvedIsland& island, const ForestMotion& motion, SolveResult* result);

}  // namespace blem_sim::dynamics
