// Velocities of an island in the space, what they are measured by, and the gradient's norms.
#pragma once

#include "problem/island_at_hand.h"

namespace blem_sim::dynamics {

/** out = M v on the island's dofs. */
void multiplyMass(const IslandAtHand& island, const Eigen::VectorXd& v, Eigen::VectorXd* out);
/** [J] Kinetic energy at a velocity. Overwrites space->mass_direction. */
double kineticEnergy(const IslandAtHand& island, const Eigen::VectorXd& velocity);

/** Scale of each dof: over the root of its own inertia. */
void setScale(const IslandAtHand& island);
/** M (v - v*) at the velocities in the space, M times them given there, too. */
void setKinetic(const IslandAtHand& island);
/** Keeps the velocities in the space, and M (v - v*), as the first ones. */
void keepFirst(const IslandAtHand& island);
void returnToFirst(const IslandAtHand& island);

/** [sqrt(kg) m/s] Largest gradient of some dofs, over the root of the dof's own inertia. */
double gradientNorm(const IslandAtHand& island, const std::vector<int>& dofs);
/** [rad/s or m/s] Largest gradient of a dof, over the dof's own inertia. */
double imbalance(const IslandAtHand& island);

}  // namespace blem_sim::dynamics
