// Work of the impulses that sweeps find.
#pragma once

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {

/** Work [J] of impulses, at the mean of the velocities with and without all of them. */
struct ImpulseWork {
  double gained = 0;     ///< by the bodies, without correcting depth, limits or loops
  double exchanged = 0;  ///< sum without signs
  double change = 0;     ///< impulses times the change of velocities that they make

  /** @param free,after velocity along the impulse without and with all impulses @param correction [J] work that corrects errors */
  void add(double impulse, double free, double after, double correction) {
    gained += 0.5 * impulse * (after + free) - correction;
    exchanged += 0.5 * std::abs(impulse * (after + free));
    change += impulse * (after - free);
  }
};

}  // namespace blem_sim::dynamics
