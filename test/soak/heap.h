// A heap to be: cubes of twelve triangles thrown over a ground of two.
#pragma once

#include <random>
#include <string>

#include "sim/simulation_scene.h"

namespace blem_sim {

/** Thirty cubes of 0.1 m and 1 kg in five layers, turned, spinning and falling as the seed says. */
inline SimulationConfig heapOfCubes(int seed, const SolverSettings& solver) {
  SimulationConfig config;
  config.solver = solver;
  config.environments = {ground(8)};
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * static_cast<double>(generator() >> 11) * 0x1p-53; };
  const auto vector = [&](double size) {
    const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
    return Vector3(x, y, z);
  };
  for (int i = 0; i < 30; ++i) {
    const Vector3 centre(0.2 * (i % 3) - 0.2, 0.2 * (i / 3 % 2) - 0.1, 0.2 + 0.2 * (i / 6));
    ObjectConfig cube = box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, Vector3::Zero());
    cube.X_WO = makePose(centre, vector(M_PI));
    cube.linear_velocity = vector(0.5);
    cube.angular_velocity = vector(5);
    config.objects.push_back(cube);
  }
  return config;
}

}  // namespace blem_sim
