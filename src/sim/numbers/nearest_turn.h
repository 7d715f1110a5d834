// Joints that turn without end take positions to the nearest turn.
#pragma once

#include <cmath>

namespace blem_sim::sim {

/**
 * [rad] The multiple of a full turn that brings a position nearest to `present`. Half a turn is as near on either side: the way then goes
 * up if the position is the larger number and down if it is the smaller, as joint_trajectory_controller has it.
 */
inline double turnsTo(double present, double position) {
  constexpr double SAME_HALF_TURN = 1e-9 / (2 * M_PI);  // [turns]
  const double turns = (present - position) / (2 * M_PI);
  const bool is_half = std::abs(std::abs(turns - std::trunc(turns)) - 0.5) < SAME_HALF_TURN;
  return 2 * M_PI * std::round(is_half ? turns + (position > present ? 0.5 : -0.5) : turns);
}

/** [rad] Way from one position to another by less than half a turn, or half a turn. */
inline double shortestTurn(double from, double to) { return to + turnsTo(from, to) - from; }

}  // namespace blem_sim::sim
