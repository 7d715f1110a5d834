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

/** Visits the trees of an island, which threads share: visit(tree). */
template <typename Visit>
void forTrees(const std::vector<int>& trees, Team* team, const Visit& visit) {
  constexpr std::size_t AT_ONCE = 32;  // the size of a chunk: some microseconds
  team->forRanges(0, trees.size(), AT_ONCE, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) visit(trees[i]);
  });
}

}  // namespace blem_sim::dynamics
