// An island on its way from the solve to the end of the step.
#pragma once

#include "problem/island_model.h"
#include "trees/forest.h"
#include "trees/team.h"

namespace blem_sim::dynamics {

/** The scene as it was at the step's start, the question, and its terms with their reactions. */
struct SolvedIsland {
  const Forest& forest;
  const Scene& scene;
  const IslandModel& model;
  const IslandTerms& found;
  double dt;   ///< [s]
  Team* team;  ///< shares loops over trees
};

}  // namespace blem_sim::dynamics
