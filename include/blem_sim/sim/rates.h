// Rates of what is published or measured again and again.
#pragma once

#include <limits>

namespace blem_sim::sim {

/** Rate of what is never due, in place of a number of Hz. */
constexpr double RATE_OFF = -std::numeric_limits<double>::infinity();

/** Rates of the node [Hz]; 0 = every step, RATE_OFF = never. */
struct PublishRates {
  double clock = 0, joint_state = 100, tf = 50, odom = 50, contact = 30, markers = 15, link_states = 50, step_report = 10;
};

}  // namespace blem_sim::sim
