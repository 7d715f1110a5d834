// Instants of a run, as they are drawn.
#pragma once

#include <vector>

#include "blem_sim/sim/simulator.h"
#include "view_options.h"

namespace blem_sim {

struct WorldFrame {
  std::vector<dynamics::BodyState> bodies;   ///< one per body slot
  std::vector<sim::ContactReport> contacts;  ///< of the step before; none at the start
};

/**
 * Simulates until options.at.
 * @return the end alone, or all pictures of a video, from the start on @throws std::runtime_error if the state stops being finite
 */
std::vector<WorldFrame> simulateFrames(const ViewOptions& options, sim::Simulator* simulator);

}  // namespace blem_sim
