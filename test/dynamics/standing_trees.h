// Trees of a scene as a step finds them: placed, with their inertias.
#pragma once

#include "problem/solver_space.h"
#include "trees/forest_motion.h"

namespace blem_sim::dynamics {

/** Builds the forest of a scene at rest, and room for its solver. */
inline void standTrees(const Scene& scene, Forest* forest, ForestMotion* motion, SolverSpace* space) {
  forest->build(scene);
  motion->resize(*forest);
  space->resize(*forest);
  for (int tree = 0; tree < static_cast<int>(forest->trees().size()); ++tree) {
    readTree(*forest, scene, tree, motion);
    placeBodies(*forest, tree, motion);
    computeInertias(*forest, tree, motion);
  }
}

}  // namespace blem_sim::dynamics
