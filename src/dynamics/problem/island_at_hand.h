// The island that is solved, as all parts of its solver see it.
#pragma once

#include "problem/island_model.h"
#include "problem/solver_space.h"
#include "trees/forest_motion.h"
#include "trees/team.h"

namespace blem_sim::dynamics {

/** The question is const; answers go to `found` and to the velocities in `space`. Valid from a solve to the end of its step. */
struct IslandAtHand {
  const Forest& forest;
  const ForestMotion& motion;
  const IslandModel& model;
  IslandAnswer* found;
  SolverSpace* space;
  Team* team;  ///< shares loops over contacts

  const ForestTree& tree(int index) const { return forest.trees()[index]; }
  IslandTerms* terms() const { return &found->terms; }
};

/** Visits the pairs, which threads share: visit(index). */
template <typename Visit>
void forPairs(const IslandAtHand& island, const Visit& visit) {
  constexpr std::size_t AT_ONCE = 64;  // the size of a chunk: some microseconds
  island.team->forRanges(0, island.model.pairs.size(), AT_ONCE, [&](std::size_t first, std::size_t end) {
    for (std::size_t p = first; p < end; ++p) visit(p);
  });
}

/** Visits all dofs of the island's trees, tree by tree. */
template <typename Visit>
void forDofs(const IslandAtHand& island, const Visit& visit) {
  for (const int tree : island.model.trees)
    for (int k = island.tree(tree).first_dof; k < island.tree(tree).dof_end; ++k) visit(k);
}

}  // namespace blem_sim::dynamics
