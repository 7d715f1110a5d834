// The iterate of an island's problem: velocities, what answers to them, and the objective's gradient.
#pragma once

#include "iterate/island_reactions.h"

namespace blem_sim::dynamics {

/** Velocities are in the space, the direction of a search too; live dofs are iterated, idle ones follow elsewhere (IdleBranches). */
class IslandIterate {
 public:
  /** Takes the velocities in the space as the first iterate of an island, and finds its live parts. */
  void start(const IslandAtHand& island);
  /** Begins the hard problem from the velocities at hand, with the live parts that are marked. */
  void begin();
  /** Goes on with the parts that were woken meanwhile. */
  void takeWoken();

  /** Fills the gradient on live dofs. @return [sqrt(kg) m/s] its norm there */
  double evaluateGradient();
  /** The same on idle dofs, by their joints' responses at the velocities in the space. */
  double evaluateIdleGradient();
  /** Changes along the direction: of momenta on live dofs, and the steps of the reactions. */
  void setDirection();
  /** Moves by a along the direction. @return [rad/s or m/s] largest change of a velocity */
  double move(double a);
  /** Writes contacts' impulses and velocities to the terms, and mimic joints' impulses to the answer. */
  void read();

  /** Parts that are woken are iterated from begin() or takeWoken() on. */
  LiveParts& live() { return live_; }
  const LiveParts& live() const { return live_; }
  IslandReactions& reactions() { return reactions_; }
  const IslandReactions& reactions() const { return reactions_; }
  /** [m/s] of the fastest contact before the solve. */
  double firstSpeed() const { return first_speed_; }

 private:
  void gradient();

  const IslandAtHand* island_ = nullptr;
  LiveParts live_;
  IslandReactions reactions_;
  double first_speed_ = 0;
};

}  // namespace blem_sim::dynamics
