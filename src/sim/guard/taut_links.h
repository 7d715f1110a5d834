// Light links between heavy things: ropes, cables, chains over pulleys.
#pragma once

#include <vector>

#include "blem_sim/dynamics/world.h"
#include "contacts/constraints/made_solve.h"
#include "guard/body_islands.h"

namespace blem_sim::sim {

/**
 * A link in tension between two free hinges swings about its middle while its neighbours swing the other way, at the rate [rad/s]
 * sqrt(tension length / inertia). A solve sees forces where the link stands at its start, and no turn of theirs [Tournier et al. 2015], so
 * these swings grow without bound if it is longer than 2 / rate: a rope of light links falls through what it is laid over.
 */
class TautLinks {
 public:
  /**
   * [s] Longest solve that links of chains that touch something can take, by the joints' forces in the one that was made; damping of their
   * hinges and armature make it longer. Infinite if no link is in tension, and of chains that nothing touches, whose free motion is
   * followed, unless that was too fast.
   */
  double longestSolve(const dynamics::World& world, const MadeSolve& made);

 private:
  void findHinges(const dynamics::World& world, const MadeSolve& made);
  void findTouched(const dynamics::World& world, const MadeSolve& made);

  // All of them are of the solve at hand.
  std::vector<int> hinges_;       // free ones
  std::vector<int> inner_;        // by body: the free hinge that carries it, or -1
  BodyIslands trees_;             // bodies that joints tie together
  std::vector<char> is_touched_;  // by body, at the least body of each tree
};

}  // namespace blem_sim::sim
