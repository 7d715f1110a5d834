#include "problem/island_velocity.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {

void multiplyMass(const IslandAtHand& island, const Eigen::VectorXd& v, Eigen::VectorXd* out) {
  for (const int tree : island.model.trees) multiply({island.forest, tree, island.motion.mass}, v, out, &island.space->paths);
}

double kineticEnergy(const IslandAtHand& island, const Eigen::VectorXd& velocity) {
  multiplyMass(island, velocity, &island.space->mass_direction);
  return 0.5 * dotProduct(island.forest, island.model.trees, velocity, island.space->mass_direction);
}

void setScale(const IslandAtHand& island) {
  forDofs(island, [&island](int k) { island.space->scale[k] = 1 / std::sqrt(island.motion.mass[island.forest.diagonal(k)]); });
}

void setKinetic(const IslandAtHand& island) {
  SolverSpace& s = *island.space;
  forDofs(island, [&s](int k) { s.kinetic[k] = s.mass_velocity[k] - s.free_momentum[k]; });
}

void keepFirst(const IslandAtHand& island) {
  SolverSpace& s = *island.space;
  forDofs(island, [&s](int k) {
    s.first_velocity[k] = s.velocity[k];
    s.first_kinetic[k] = s.kinetic[k];
  });
}

void returnToFirst(const IslandAtHand& island) {
  SolverSpace& s = *island.space;
  forDofs(island, [&s](int k) {
    s.velocity[k] = s.first_velocity[k];
    s.kinetic[k] = s.first_kinetic[k];
  });
}

double gradientNorm(const IslandAtHand& island, const std::vector<int>& dofs) {
  const SolverSpace& s = *island.space;
  double worst = 0;
  for (const int k : dofs) worst = std::max(worst, std::abs(s.gradient[k]) * s.scale[k]);
  return worst;
}

double imbalance(const IslandAtHand& island) {
  const SolverSpace& s = *island.space;
  double worst = 0;
  forDofs(island, [&](int k) { worst = std::max(worst, std::abs(s.gradient[k]) * s.scale[k] * s.scale[k]); });
  return worst;
}

}  // namespace blem_sim::dynamics
