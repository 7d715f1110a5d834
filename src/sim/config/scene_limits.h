#pragma once

#include <cstddef>

namespace blem_sim::sim {

/** Robots, objects and environments that a simulation takes: each needs some 30 kB. */
constexpr std::size_t MOST_MODELS = 100000;

// Larger numbers have no meaning in a scene of robots, and would make others that are not finite.
constexpr double LARGEST_GRAVITY = 1e4;  ///< [m/s^2]
constexpr double FASTEST = 1e5;          ///< [m/s] and [rad/s]
constexpr double WIDEST_LAYER = 1e3;     ///< [m]

}  // namespace blem_sim::sim
