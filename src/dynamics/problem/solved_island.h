// An island on its way from the solve to the end of the step.
#pragma once

#include "problem/island_model.h"
#include "trees/forest.h"

namespace blem_sim::dynamics {

/** What is known of it: the scene as it was at the start, the question, and the terms with their reactions. */
struct SolvedIsland {
  const Forest& forest;
  const Scene& scene;
  const IslandModel& model;
  const IslandTerms& found;
  double dt;  ///< [s]
};

}  // namespace blem_sim::dynamics
