// Signs in a run's report that it may not be trusted: energy out of nothing, contacts outside their boundary layers.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/sim/simulator.h"
#include "json_writer.h"

namespace blem_sim {

class TrustRecord {
 public:
  static constexpr std::size_t MOST_EVENTS = 100;  ///< listed; all are counted
  void add(const sim::StepReport& report);
  /** Writes the record as keys of the open object. */
  void write(const sim::Simulator& simulator, JsonWriter& json) const;

 private:
  double gained_ = 0, worst_gain_ = 0;  // [J]
  double worst_gain_time_ = 0;          // [s]
  std::uint64_t event_count_ = 0;
  std::vector<sim::LayerEventReport> events_;  // the first ones
};

}  // namespace blem_sim
