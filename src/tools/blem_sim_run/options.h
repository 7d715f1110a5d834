// The command line of blem_sim_run.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line.h"

namespace blem_sim {

struct RunOptions {
  bool help = false, version = false;
  std::string config;
  double duration = 10;                                       ///< [s] simulated
  std::vector<std::pair<std::string, std::string>> settings;  ///< --set key.path=value, in order
  std::vector<std::pair<std::string, std::string>> stops;     ///< --stop name=expression, in order
  std::string trajectory;
  double stats_from = 0;  ///< [s] simulated
  std::string csv;
  double csv_rate = 100;  ///< [Hz], 0 = every step
  std::string report;     ///< empty: standard output
  std::optional<std::uint64_t> seed;
  std::map<std::string, std::string> packages;
  std::string save_state, load_state;
  std::string batch;  ///< file of runs, one per line; empty: a single run
  std::string name;   ///< of a run of a batch
};

extern const char* const RUN_USAGE;

/** Options of a run that take a value. */
const OptionTable<RunOptions>& runOptionTable();

/** @throws InputError for an unknown option, a missing or malformed value, no configuration */
RunOptions parseOptions(const std::vector<std::string>& arguments);

}  // namespace blem_sim
