#include "options.h"

#include <fmt/format.h>

#include <sstream>

#include "blem_sim/geometry/input_error.h"
#include "command_line.h"

namespace blem_sim {

const char* const RUN_USAGE = R"(Simulates a world without ROS, as fast as it goes.

blem_sim_run CONFIG.yaml [options]
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
  --version               the version of blem_sim, and the compiler that made it
  --help                  this text
Exit status: 0 finished; 2 bad input, told in one line; 3 the state stopped being finite.
)";

namespace {

std::uint64_t seedNumber(const std::string& option, const std::string& text) {
  std::istringstream stream(text);
  std::uint64_t value = 0;
  if (text.find_first_not_of("0123456789") != std::string::npos || !(stream >> value))
    throw InputError(fmt::format("{}: '{}' is not a whole number of at least 0", option, text));
  return value;
}

const OptionTable<RunOptions>& optionTable() {
  static const OptionTable<RunOptions> table = {
      {"--duration", number(&RunOptions::duration)},
      {"--stats-from", number(&RunOptions::stats_from)},
      {"--csv-rate", number(&RunOptions::csv_rate)},
      {"--trajectory", text(&RunOptions::trajectory)},
      {"--csv", text(&RunOptions::csv)},
      {"--report", text(&RunOptions::report)},
      {"--save-state", text(&RunOptions::save_state)},
      {"--load-state", text(&RunOptions::load_state)},
      {"--seed", [](RunOptions& o, const std::string& option, const std::string& value) { o.seed = seedNumber(option, value); }},
      {"--set",
       [](RunOptions& o, const std::string& option, const std::string& value) { o.settings.push_back(assignment(option, value)); }},
      {"--stop", [](RunOptions& o, const std::string& option, const std::string& value) { o.stops.push_back(assignment(option, value)); }},
      {"--package",
       [](RunOptions& o, const std::string& option, const std::string& value) { o.packages.insert(assignment(option, value)); }},
  };
  return table;
}

}  // namespace

RunOptions parseOptions(const std::vector<std::string>& arguments) {
  RunOptions options;
  const std::vector<std::string> files = readArguments(arguments, optionTable(), {{"--version", &RunOptions::version}}, &options);
  if (options.help || options.version) return options;
  if (files.empty()) throw InputError("CONFIG.yaml is missing; --help says more");
  if (files.size() > 1) throw InputError(fmt::format("'{}': there is a configuration already, {}", files[1], files[0]));
  options.config = files[0];
  return options;
}

}  // namespace blem_sim
