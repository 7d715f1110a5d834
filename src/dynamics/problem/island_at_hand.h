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

/** Visits the pairs of an island, which threads share: visit(index). */
template <typename Visit>
void forPairs(const IslandModel& model, Team* team, const Visit& visit) {
  constexpr std::size_t AT_ONCE = 64;  // the size of a chunk: some microseconds
  team->forRanges(0, model.pairs.size(), AT_ONCE, [&](std::size_t first, std::size_t end) {
    for (std::size_t p = first; p < end; ++p) visit(p);
  });
}
template <typename Visit>
void forPairs(const IslandAtHand& island, const Visit& visit) {
  forPairs(island.model, island.team, visit);
}

/** Visits the trees of an island, which threads share: visit(tree). */
template <typename Visit>
void forTrees(const IslandModel& model, Team* team, const Visit& visit) {
  constexpr std::size_t AT_ONCE = 32;  // the size of a chunk: some microseconds
  team->forRanges(0, model.trees.size(), AT_ONCE, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) visit(model.trees[i]);
  });
}

/** Visits all dofs of the island's trees, tree by tree. */
template <typename Visit>
void forDofs(const IslandAtHand& island, const Visit& visit) {
  for (const int tree : island.model.trees)
    for (int k = island.tree(tree).first_dof; k < island.tree(tree).dof_end; ++k) visit(k);
}

}  // namespace blem_sim::dynamics
