// Wrenches of an island's joints over an accepted step.
#pragma once

#include "free_way/free_motion.h"
#include "problem/solved_island.h"
#include "problem/solver_space.h"

namespace blem_sim::dynamics {

/** Wrench from each joint's parent on its child: Newton-Euler backwards over the step, about the joint frame's origin at the step's start,
 *  for a fast tree at its middle. */
void computeWrenches(const SolvedIsland& island, const FreeMotion& way, ForestMotion* motion, SolverSpace* space,
                     std::vector<Wrench>* wrenches);

}  // namespace blem_sim::dynamics
