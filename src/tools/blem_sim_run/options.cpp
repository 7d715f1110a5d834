#include "options.h"

#include <fmt/format.h>

#include <sstream>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim {

const char* const RUN_USAGE = R"(Simulates a world without ROS, as fast as it goes.

blem_sim_run CONFIG.yaml [options]
blem_sim_run [CONFIG.yaml] --batch RUNS.jsonl [options]
  CONFIG.yaml             the node's parameters (config/default.yaml is their manual), with urdf: FILE for robots
  --duration S            [s] to simulate (10)
  --set KEY.PATH=VALUE    sets a parameter: contact.friction=0.3, robots.0.gains.default.p=50; may be repeated
  --seed N                the same as --set random_seed=N
  --package NAME=DIR      where package://NAME is; asked before ROS_PACKAGE_PATH; may be repeated
  --trajectory FILE.csv   commanded at the start to the first robot that has joints of its columns: time [s], one column per joint,
                          NAME_vel for velocities; other columns are ignored with a note
  --stop NAME=EXPR        ends the run after the first step after which EXPR holds: 'fallen=hubo::torso.z < 0.4'; may be repeated.
                          Names: time, energy, status bits, MODEL::LINK.x .y .z .speed .roll .pitch .yaw, MODEL::JOINT.position
                          .velocity .effort, SENSOR.FIELD as in --csv ("NAME" in quotes if it has other signs);
                          + - * /, comparisons, and or not, abs sqrt min max
  --report OUT.json       where the report goes (standard output)
  --stats-from S          [s] simulated time from which on sensors are averaged (0)
  --csv OUT.csv           joints, free bodies and sensors over time
  --csv-rate HZ           rows per simulated second (100); 0 = every step
  --save-state FILE       writes the state at the end
  --load-state FILE       starts from a state that the same CONFIG.yaml has saved
  --batch RUNS.jsonl      many runs in one process, a JSON object on each line: {"name": "slow", "set": {"contact.friction": 0.3}, "duration": 2}.
                          Keys, all optional: name (run_1 on line 1, ...), config, set, stop ({NAME: EXPR} or ["NAME=EXPR"]), seed, duration,
                          trajectory, csv, csv_rate, stats_from, report, load_state, save_state; other options hold for all runs.
                          Results, by --report too, are a line for each: a run's report with its name, or {"name", "error"}
  --version               the version of blem_sim, and the compiler that made it
  --help                  this text
Exit status: 0 finished; 2 bad input, told in one line; 3 the state stopped being finite. Of a batch: 2 if any run was refused, else 3 if
any state stopped being finite, else 0. SIGINT and SIGTERM end a batch after the step, with results and tables whole.
)";

namespace {

std::uint64_t seedNumber(const std::string& option, const std::string& text) {
  std::istringstream stream(text);
  std::uint64_t value = 0;
  if (text.find_first_not_of("0123456789") != std::string::npos || !(stream >> value))
    throw InputError(fmt::format("{}: '{}' is not a whole number of at least 0", option, text));
  return value;
}

/** @throws InputError for a file that each run of a batch would write anew */
void checkBatch(const RunOptions& options) {
  const auto refuse = [&](const char* option, const char* key, const std::string& file) {
    if (!options.batch.empty() && !file.empty())
      throw InputError(
          fmt::format("{}: each run of the batch would write {}; give {} in the lines of {}", option, file, key, options.batch));
  };
  refuse("--csv", "csv", options.csv);
  refuse("--save-state", "save_state", options.save_state);
}

}  // namespace

const OptionTable<RunOptions>& runOptionTable() {
  static const OptionTable<RunOptions> table = {
      {"--duration", number(&RunOptions::duration)},
      {"--stats-from", number(&RunOptions::stats_from)},
      {"--csv-rate", number(&RunOptions::csv_rate)},
      {"--trajectory", text(&RunOptions::trajectory)},
      {"--csv", text(&RunOptions::csv)},
      {"--report", text(&RunOptions::report)},
      {"--save-state", text(&RunOptions::save_state)},
      {"--load-state", text(&RunOptions::load_state)},
      {"--batch", text(&RunOptions::batch)},
      {"--seed", [](RunOptions& o, const std::string& option, const std::string& value) { o.seed = seedNumber(option, value); }},
      {"--set",
       [](RunOptions& o, const std::string& option, const std::string& value) { o.settings.push_back(assignment(option, value)); }},
      {"--stop", [](RunOptions& o, const std::string& option, const std::string& value) { o.stops.push_back(assignment(option, value)); }},
      {"--package",
       [](RunOptions& o, const std::string& option, const std::string& value) { o.packages.insert(assignment(option, value)); }},
  };
  return table;
}

RunOptions parseOptions(const std::vector<std::string>& arguments) {
  RunOptions options;
  const std::vector<std::string> files = readArguments(arguments, runOptionTable(), {{"--version", &RunOptions::version}}, &options);
  if (options.help || options.version) return options;
  checkBatch(options);
  if (files.empty() && !options.batch.empty()) return options;
  if (files.empty()) throw InputError("CONFIG.yaml is missing; --help says more");
  if (files.size() > 1) throw InputError(fmt::format("'{}': there is a configuration already, {}", files[1], files[0]));
  options.config = files[0];
  return options;
}

}  // namespace blem_sim
