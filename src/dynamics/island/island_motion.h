// Motion of an island's trees before and after its problem is solved.
#pragma once

#include "free_way/free_motion.h"
#include "problem/solved_island.h"
#include "problem/solver_space.h"
#include "scene/stepper.h"

namespace blem_sim::dynamics {

/**
 * Lets bodies of a tree that was just read, and move otherwise than their fixed joints allow, as things do that were just welded, come to
 * move together as in a plastic impact: with the velocities of least kinetic energy of the difference, which keep the tree's momentum.
 */
void joinVelocities(const Forest& forest, const Scene& scene, int tree, ForestMotion* motion, SolverSpace* space);

/** Sets the momentum of a free tree that was just read to that of its velocities. */
void takeMomentum(const Forest& forest, int tree, ForestMotion* motion, SolverSpace* space);

/** A tree before the solve of its island. */
struct TreeAhead {
  const Forest& forest;
  const Scene& scene;
  const StepInput& input;
  int tree;
  bool touched;  ///< contacts act on its island
};

/**
 * Fills space->free_momentum, M v*, the first guess of the velocities, and M times them, space->mass_velocity. A free root's rows carry its
 * momentum from step to step, so that none is lost to the change of the mass matrix; velocity products are those of the middle of the step,
 * guessed from the last one. A tree whose velocities they change by too much for one guess is fast: they act on its way instead, after the
 * solve.
 */
void setFreeMomentum(const TreeAhead& ahead, ForestMotion* motion, SolverSpace* space);

/** A tree that nothing drives or ties is fast in this step, whatever its speed. After setFreeMomentum, before the solve. */
void followAlone(const TreeAhead& ahead, ForestMotion* motion, SolverSpace* space);

/** Follows the free motion of fast trees from the velocities that were solved. @return false if one was too fast to be followed */
bool followFast(const SolvedIsland& island, const ForestMotion& motion, const SolverSpace& space, FreeMotion* way);

/** Adds the efforts given in advance, and what viscous friction has of leads. */
void addEfforts(const StepInput& input, const IslandTerms& terms, SolverSpace* space);

/**
 * Takes the velocity products at the middle of the step that was solved. A tree that this step made fast, as an impact or a motor does
 * that tears it out of rest, is fast from now on, unless motors act against contacts.
 * @return [sqrt(kg) m/s] change of the free momentum, infinite for such a tree
 */
double correctProducts(const TreeAhead& ahead, ForestMotion* motion, SolverSpace* space);

/** Moves the trees to the end of the step. Islands with a tree that is too fast gain no energy on the way. */
void advanceIsland(const SolvedIsland& island, const FreeMotion& way, ForestMotion* motion, SolverSpace* space);

}  // namespace blem_sim::dynamics
