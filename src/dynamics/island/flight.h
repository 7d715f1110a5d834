// Flight of free trees through parts of a step.
#pragma once

#include "island/island.h"
#include "problem/solved_island.h"

namespace blem_sim::dynamics {

/**
 * Velocities stand half a step before their poses, since bodies move by the velocity at a step's end. Parts of a step would take them to
 * stand half a part before: flight and bounces would gain or lose height with each change. So a free tree that nothing bears sets out with
 * the velocity that it has half a part before its pose (ForestMotion::lead), and has that of the step again at the end. Call before all
 * else that asks for velocities; nothing changes in whole steps.
 * @return whether any tree of the island is in flight
 */
bool setOutInFlight(const TermSource& source, const Island& island, ForestMotion* motion);

/** Whether contacts pushed a tree in flight, beside impacts: it should not have been led. After the solve, impacts not added yet. */
bool hasLanded(const Island& island, const Forest& forest, const ForestMotion& motion);

/** Gives the island's trees the velocities that they had before setOutInFlight. */
void breakOffFlight(const Forest& forest, const std::vector<int>& trees, ForestMotion* motion);

/** Gives trees in flight the velocity of the step at the end of their way, and adds to the result's free_ways. */
void endFlight(const SolvedIsland& island, double of_step, ForestMotion* motion, SolveResult* result);

}  // namespace blem_sim::dynamics
