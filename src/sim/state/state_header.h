// Header of a saved state.
#pragma once

#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::sim {

/** The header that goes with a content. */
StateHeader headerOf(const SimulationState& state);

/** @throws InputError in one line: another version's, cut short, or changed since it was saved */
void checkHeader(const SimulationState& state);

}  // namespace blem_sim::sim
