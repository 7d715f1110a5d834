// Scenes in which a body passes beside another: nothing but contacts changes its velocity.
#pragma once

#include "sim/simulation_scene.h"

namespace blem_sim::sim {

constexpr double LAYER = 0.0025;  // [m] of objects and robots; environments have none

inline SimulationConfig weightless(double dt) {
  SimulationConfig config;
  config.gravity.setZero();
  config.time_step = dt;
  return config;
}

}  // namespace blem_sim::sim
