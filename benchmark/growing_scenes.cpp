#include "growing_scenes.h"

#include <algorithm>
#include <cmath>

#include "sim/simulation_scene.h"

namespace blem_sim {
namespace {

constexpr int IN_A_ROW = 8, MOST_IN_ROWS_OF_EIGHT = 200;
constexpr double CUBE = 0.1, APART = 0.5, GROUND = 20;  // [m]
constexpr double LIFTED = 0.005;                        // [m] to fall, layers included

void stack(const Vector3& foot, int cubes, const sim::ObjectConfig& cube, sim::SimulationConfig* config) {
  for (int level = 0; level < cubes; ++level) {
    config->objects.push_back(cube);
    config->objects.back().name = "cube" + std::to_string(config->objects.size() - 1);
    config->objects.back().X_WO.translation() = foot + Vector3(0, 0, (level + 0.5) * CUBE + (level + 1) * LIFTED);
  }
}

sim::SimulationConfig stacks(int count, int cubes) {
  sim::SimulationConfig config;
  // A square of many, so that the ground stays small.
  const int row = count <= MOST_IN_ROWS_OF_EIGHT ? IN_A_ROW : static_cast<int>(std::ceil(std::sqrt(count)));
  const double corner = row == IN_A_ROW ? 2 : 0.5 * APART * row;
  config.environments = {sim::ground(std::max(GROUND, 2 * corner + 2))};
  const sim::ObjectConfig cube = sim::box("cube", Vector3::Constant(CUBE), 1, Vector3::Zero());
  for (int i = 0; i < count; ++i) stack(Vector3(APART * (i % row) - corner, APART * (i / row) - corner, 0), cubes, cube, &config);
  return config;
}

}  // namespace

sim::SimulationConfig cubesOnGround(int cubes) { return stacks(cubes, 1); }

sim::SimulationConfig stacksOfThree(int count, int threads) {
  sim::SimulationConfig config = stacks(count, 3);
  config.solver.threads = threads;
  return config;
}

}  // namespace blem_sim
