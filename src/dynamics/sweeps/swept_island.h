// An island that is swept: sweeps on its terms, and their impulses as the iterate of Newton's method.
#pragma once

#include "newton/newton_loop.h"
#include "sweeps/impulse_work.h"
#include "sweeps/island_sweeps.h"

namespace blem_sim::dynamics {

class SweptIsland {
 public:
  static constexpr int MOST_SWEEPS = 240;

  void start(const IslandAtHand& island, NewtonLoop* newton);
  /** Loads the terms at hand, and the velocities that the island came with. @return false if a mass matrix is not positive definite */
  bool load(SweepStart start);
  /** Sweeps the velocities in the space on. Precondition: loaded */
  SweepReport sweep(int most, double enough) { return sweeps_.sweep(most, enough, &island_->space->velocity); }
  /** Loads, and sweeps until impulses change by less than `enough` of the largest; again, four times at most, until exactly those motors
   * are at their bounds that were swept. @return false as load() */
  bool sweepWithMotors(SweepStart start, double enough, SweepReport* report);

  /** The impulses found become the terms' and the iterate's, scaled down if they would add kinetic energy to that of free motion.
   *  @return [sqrt(kg) m/s] gradient */
  double adopt();
  /** The same again, after something else was tried. */
  double adoptAgain();
  /** Velocities without any impulse of contacts, joint friction, limits and loops, but with motors. */
  void freeVelocity(Eigen::VectorXd* velocity) { sweeps_.freeVelocity(velocity); }

 private:
  double adoptImpulses();
  ImpulseWork impulseWork();

  const IslandAtHand* island_ = nullptr;
  NewtonLoop* newton_ = nullptr;
  IslandSweeps sweeps_;
};

}  // namespace blem_sim::dynamics
