#include "growing_scenes.h"

#include "sim/simulation_scene.h"

namespace blem_sim {
namespace {

constexpr int IN_A_ROW = 8;
constexpr double CUBE = 0.1, APART = 0.5, GROUND = 20;  // [m]
constexpr double LIFTED = 0.005;                        // [m] to fall, layers included

void stack(int place, int cubes, SimulationConfig* config) {
  for (int level = 0; level < cubes; ++level) {
    const Vector3 centre(APART * (place % IN_A_ROW) - 2, APART * (place / IN_A_ROW) - 2, (level + 0.5) * CUBE + (level + 1) * LIFTED);
    const std::string name = "cube" + std::to_string(cubes * place + level);
    config->objects.push_back(box(name, Vector3::Constant(CUBE), 1, centre));
  }
}

SimulationConfig stacks(int count, int cubes) {
  SimulationConfig config;
  config.environments = {ground(GROUND)};
  for (int i = 0; i < count; ++i) stack(i, cubes, &config);
  return config;
}

}  // namespace

SimulationConfig cubesOnGround(int cubes) { return stacks(cubes, 1); }

SimulationConfig stacksOfThree(int count, int threads) {
  SimulationConfig config = stacks(count, 3);
  config.solver.threads = threads;
  return config;
}

}  // namespace blem_sim
