// Joints that turn without end take positions to the nearest turn.
#pragma once

#include <cmath>

namespace blem_sim {

/** [rad] The multiple of a full turn that brings a position nearest to `present`. */
inline double turnsTo(double present, double position) { return 2 * M_PI * std::round((present - position) / (2 * M_PI)); }

}  // namespace blem_sim
