// A contact as one row of an array of numpy.
#pragma once

#include <cstdint>

namespace blem_sim::python {

struct SimulationContact {
  std::int32_t body_a, body_b;  ///< rows of body_names; -1: the world
  double point[3], normal[3];   ///< [m], 1: world, the normal from B to A
  double force[3];              ///< [N] on A, world axes, mean over the step
  double depth, of_layer;       ///< [m]; depth over both layers
};

}  // namespace blem_sim::python
