// Settings of Newton's method, and what it reports.
#pragma once

#include "iterate/island_iterate.h"

namespace blem_sim::dynamics {

constexpr int FIRST_ITERATIONS = 4;  // of the hard problem; each later one must lead on, or soft contacts or sweeps follow
constexpr double BALANCED = 1e-5;    // [rad/s or m/s] most that a step may miss momentum's balance

struct NewtonSettings {
  int max_iterations = 100;           ///< over all proximal steps
  int max_outer = 12;                 ///< proximal steps
  double gradient_tolerance = 1e-10;  ///< [sqrt(kg) m/s]
  double contact_tolerance = 1e-7;    ///< [N s]
  double joint_tolerance = 1e-7;      ///< [rad/s or m/s]
};

/** Effort and quality of a solve. */
struct NewtonReport {
  int iterations = 0;
  double gradient = 0;          ///< [sqrt(kg) m/s] norm at the end of the last proximal step
  double contact_residual = 0;  ///< [N s] largest violation of Coulomb's law over the contacts
  double contact_creep = 0;     ///< [m/s] the same as velocities, beyond a thousandth of the fastest contact's before the solve
  double joint_creep = 0;       ///< [rad/s or m/s] largest creep of a joint that sticks, miss of a limit or of a loop
  double imbalance = 0;         ///< [rad/s or m/s] difference of momentum and impulses, over the dof's inertia; worst dof
};

/** Fills the qualities of an iterate whose gradient was evaluated; iterations and gradient are left. */
void assess(const IslandAtHand& island, const IslandIterate& iterate, NewtonReport* report);

/** Whether momentum and Coulomb's law hold within the tolerances. */
bool isExact(const NewtonSettings& settings, const NewtonReport& report);

}  // namespace blem_sim::dynamics
