// Bounds on contacts that correct depth: on their pushes and the energy they add; and on velocities where nothing solved the problem.
#pragma once

#include "problem/island_at_hand.h"

namespace blem_sim::dynamics {

/**
 * Contacts and loops that have added far more energy than moving the island at their speed takes are to correct less, contacts that push
 * hard nothing. Overwrites space->mass_direction.
 * @param speed [m/s] at which contacts correct depth at most
 * @return whether there were such; their terms at hand are changed
 */
bool boundCorrections(const IslandAtHand& island, double speed);

/**
 * The last resort where nothing found a solution: contacts that contradict each other may ask for any speed. All velocities shrink alike
 * until the island moves with no more energy than without contacts, or than it needs to move at the fastest target of its contacts.
 * Overwrites space->mass_direction.
 * @param free_velocity without contacts
 */
void boundEnergy(const IslandAtHand& island, const Eigen::VectorXd& free_velocity);

}  // namespace blem_sim::dynamics
