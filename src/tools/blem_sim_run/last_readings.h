// The last readings of all sensors, as numbers with names.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/sim/simulator.h"

namespace blem_sim {

class LastReadings {
 public:
  explicit LastReadings(const sim::Simulator& simulator);
  /** Takes the readings of a step; sensors without one keep theirs. */
  void add(const sim::StepReport& report);

  /** SENSOR.FIELD, sensor by sensor. */
  const std::vector<std::string>& names() const { return names_; }
  /** In the order of names; NaN before a sensor's first reading. */
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
  std::vector<std::size_t> firsts_;  ///< of each sensor among values_
};

}  // namespace blem_sim
