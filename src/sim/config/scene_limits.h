#pragma once

#include <cstddef>

namespace blem_sim::sim {

/** Robots, objects and environments that a simulation takes: each needs some 30 kB. */
constexpr std::size_t MOST_MODELS = 100000;

}  // namespace blem_sim::sim
