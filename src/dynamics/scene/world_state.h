// Reading a WorldState.
#pragma once

#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/geometry/state_stream.h"

namespace blem_sim::dynamics {

/** Reads a state from its beginning; one that is of other bodies or joints is refused in a line of the world's own. */
inline geometry::StateReader readerOf(const WorldState& state) {
  return geometry::StateReader(
      state, "world state: it was not saved from a world with these bodies and joints; load it into the scene it came from");
}

}  // namespace blem_sim::dynamics
