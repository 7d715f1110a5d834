// Record of a run: counted step by step, written as one JSON object at the end.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "blem_sim/sim/simulator.h"
#include "json_writer.h"
#include "statistics.h"
#include "trust_record.h"

namespace blem_sim {

/** Time that a run took [s]. */
struct RunTimes {
  double cpu = 0, wall = 0;
};

/** Facts about a run that its steps do not tell. */
struct RunFacts {
  std::string name;  ///< of a run of a batch, or empty
  RunTimes times;
  std::vector<std::string> notes;
};

class RunRecord {
 public:
  /** @param stats_from [s] simulated time after which sensors count */
  RunRecord(const sim::Simulator& simulator, double stats_from);
  void add(const sim::StepReport& report);
  /** The run ends now, for the reason of this name. */
  void stop(const std::string& name);
  /** A signal of this name ends the run now. */
  void interrupt(const std::string& signal) { interrupted_ = signal; }
  void write(const RunFacts& facts, JsonWriter& json) const;

 private:
  struct Deepest {
    double depth = 0, of_layer = 0, time = 0;
    int collider_a = -1, collider_b = -1;
  };

  void addDepth(const sim::StepReport& report);
  void writeStatus(JsonWriter& json) const;
  void writeProfile(JsonWriter& json) const;
  void writeContacts(JsonWriter& json) const;
  void writeBodies(JsonWriter& json) const;
  void writeJoints(JsonWriter& json) const;
  void writeSensors(JsonWriter& json) const;
  void writeLoadReport(JsonWriter& json) const;

  const sim::Simulator& simulator_;
  double stats_from_ = 0;
  std::uint64_t steps_ = 0, raw_contacts_ = 0, reduced_contacts_ = 0;
  int most_reduced_contacts_ = 0;
  double wrench_error_ = 0;
  std::string stopped_;  ///< name of the --stop; empty without one
  double stop_time_ = 0;
  std::string interrupted_;                  ///< name of the signal; empty without one
  std::vector<std::uint64_t> status_steps_;  ///< per bit
  std::array<Distribution, static_cast<int>(sim::Stage::COUNT)> stages_;
  Distribution step_;
  Deepest deepest_;
  TrustRecord trust_;
  std::vector<VectorStatistics> sensors_;
};

}  // namespace blem_sim
