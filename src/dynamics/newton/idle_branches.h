// Idle branches: branches of trees that nothing touches are not iterated, but follow the others, as long as their joints answer linearly.
#pragma once

#include <vector>

#include "iterate/island_iterate.h"

namespace blem_sim::dynamics {

class IdleBranches {
 public:
  /** End of following. */
  enum class Outcome {
    FOLLOWED,     ///< their joints have answered linearly
    FEW_STRAYED,  ///< a few have left the piece of their response that they were on, and are live from now on
    STRAYED       ///< many have, or some again: all are live from now on
  };

  void start(const IslandAtHand& island, IslandIterate* iterate);
  /** Forgets the elimination: other dofs are idle, or their terms have changed. */
  void forget() { base_ = Base::UNKNOWN; }

  /** Whether they follow, so that the velocities of idle dofs are not known. */
  bool areFollowing() const { return base_ == Base::FOLLOWED; }
  /** Whether the elimination holds for the responses at hand. */
  bool isBaseCurrent() const;
  /** Eliminates idle dofs at their joints' responses at hand: live dofs keep the rest of M. @return false if not positive definite */
  bool eliminateIdle();
  /** They follow from the velocities at hand on: their joints' responses at hand are extended linearly. Precondition: a current base */
  void follow();
  /**
   * Ends following: finds the velocities of idle dofs, and wakes those that stray.
   * @param enough [sqrt(kg) m/s] difference of joints' impulses from those extended linearly that is none
   * @param missed [sqrt(kg) m/s] that difference, out
   */
  Outcome settle(double enough, double* missed);

 private:
  enum class Base {
    UNKNOWN,
    ELIMINATED,  ///< at the joints' stiffnesses that are noted
    FOLLOWED     ///< and live dofs move without them
  };
  double findVelocities();
  void solveIdle();
  Outcome wakeStrays(double enough);

  const IslandAtHand* island_ = nullptr;
  IslandIterate* iterate_ = nullptr;
  Base base_ = Base::UNKNOWN;
  bool have_strayed_ = false;            // once in this solve
  std::vector<double> joint_stiffness_;  // lane by lane, of the base
};

}  // namespace blem_sim::dynamics
