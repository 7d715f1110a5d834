// Steps at which a sensor is read.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace blem_sim::sim {

/** Counts steps, so that a rate holds on average whatever the step: 300 Hz at 1 ms are 300 readings a second, 3 or 4 steps apart. */
class SensorSchedule {
 public:
  /** @param rate [Hz]; 0 = every step, and so is what is faster than the steps; below 0 = never @param time_step [s] */
  SensorSchedule(double rate, double time_step)
      : readings_per_step_(rate == 0 ? 1 : std::clamp(rate * time_step, 0.0, 1.0)), period_(time_step / readings_per_step_) {}

  /** @param step number of the step that has ended, from 1 */
  bool due(std::uint64_t step) const { return readingsUntil(step) != readingsUntil(step - 1); }
  /** [s] between two readings, on average; infinite if there are none. */
  double period() const { return period_; }

 private:
  // A whole number of periods may fall short of it by rounding.
  double readingsUntil(std::uint64_t step) const { return std::floor(static_cast<double>(step) * readings_per_step_ * (1 + 1e-15)); }

  double readings_per_step_, period_;
};

}  // namespace blem_sim::sim
