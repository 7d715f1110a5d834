// Readings on their way from a sensor, for a whole number of steps.
#pragma once

#include <cstddef>
#include <vector>

#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/sim/step_report.h"

namespace blem_sim::sim {

class DelayLine {
 public:
  /** @param delay, time_step [s] @param reading one like those that will come */
  DelayLine(double delay, double time_step, SensorReading reading);

  std::size_t steps() const { return steps_; }
  /** Takes in the reading of a step, and turns it into the one of steps() earlier. @return false: there was none yet */
  bool pass(SensorReading* reading);
  /** Nothing is on its way any more. */
  void clear();

  /** Saves the readings that are on their way; nothing without a delay. */
  void save(geometry::StateWriter* writer) const;
  void restore(geometry::StateReader* reader);

 private:
  std::size_t steps_;
  std::vector<double> numbers_;  ///< of the readings, those of the next to come at next_
  std::size_t next_ = 0, taken_ = 0;
};

}  // namespace blem_sim::sim
