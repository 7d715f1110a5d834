// What happens to an island's trees before and after its problem is solved.
#pragma once

#include "forest_motion.h"
#include "island_problem.h"
#include "stepper.h"

namespace blem_sim {

/** The momentum of a free tree that was just read: that of its velocities. */
void takeMomentum(const Forest& forest, int tree, ForestMotion* motion, SolverSpace* space);

/**
 * Fills space->free_momentum, M v*, the first guess of the velocities, and M times them, space->mass_velocity. A free root's rows carry its
 * momentum from step to step, so that none is lost to the change of the mass matrix; velocity products are those of the middle of the step,
 * guessed from the last one.
 */
void setFreeMomentum(const Forest& forest, const Scene& scene, int tree, double dt, ForestMotion* motion, SolverSpace* space);

/** Adds the efforts given in advance. */
void addEfforts(const StepInput& input, const IslandProblem& problem, SolverSpace* space);

/** Takes the velocity products at the middle of the step that was solved. @return [sqrt(kg) m/s] by how much the free momentum changed */
double correctProducts(const Forest& forest, int tree, double dt, ForestMotion* motion, SolverSpace* space);

/** What each joint's child feels from the parent: Newton-Euler backwards over the step, about the joint frame's origin at its start. */
void computeWrenches(const Forest& forest, const Scene& scene, const IslandProblem& problem, double dt, ForestMotion* motion,
                     SolverSpace* space, std::vector<Wrench>* wrenches);

/** Moves the trees to the end of the step. */
void advanceIsland(const Forest& forest, const IslandProblem& problem, double dt, ForestMotion* motion, const SolverSpace& space);

void saveTree(const Forest& forest, int tree, const ForestMotion& motion, StateWriter* writer);
void restoreTree(const Forest& forest, int tree, ForestMotion* motion, StateReader* reader);

}  // namespace blem_sim
