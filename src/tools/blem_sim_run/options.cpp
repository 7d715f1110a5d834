#include "options.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <locale>
#include <sstream>

#include "blem_sim/geometry/input_error.h"

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
  --report OUT.json       where the report goes (standard output)
  --stats-from S          [s] simulated time from which on sensors are averaged (0)
  --csv OUT.csv           joints, free bodies and sensors over time
  --csv-rate HZ           rows per simulated second (100); 0 = every step
  --save-state FILE       writes the state at the end
  --load-state FILE       starts from a state that the same CONFIG.yaml has saved
  --help                  this text
Exit status: 0 finished; 2 bad input, told in one line; 3 the state stopped being finite.
)";

namespace {

double seconds(const std::string& option, const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0;
  if (!(stream >> value) || !stream.eof() || !std::isfinite(value) || value < 0)
    throw InputError(fmt::format("{}: '{}' is not a number of at least 0", option, text));
  return value;
}

std::uint64_t seedNumber(const std::string& option, const std::string& text) {
  std::istringstream stream(text);
  std::uint64_t value = 0;
  if (text.find_first_not_of("0123456789") != std::string::npos || !(stream >> value))
    throw InputError(fmt::format("{}: '{}' is not a whole number of at least 0", option, text));
  return value;
}

std::pair<std::string, std::string> assignment(const std::string& option, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw InputError(fmt::format("{}: '{}' is not NAME=VALUE", option, text));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

using Take = std::function<void(RunOptions&, const std::string& option, const std::string& value)>;

Take text(std::string RunOptions::*field) {
  return [field](RunOptions& options, const std::string&, const std::string& value) { options.*field = value; };
}

Take number(double RunOptions::*field) {
  return [field](RunOptions& options, const std::string& option, const std::string& value) { options.*field = seconds(option, value); };
}

/** A new option is one row. */
const std::map<std::string, Take>& optionTable() {
  static const std::map<std::string, Take> table = {
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
      {"--package",
       [](RunOptions& o, const std::string& option, const std::string& value) { o.packages.insert(assignment(option, value)); }},
  };
  return table;
}

}  // namespace

RunOptions parseOptions(const std::vector<std::string>& arguments) {
  RunOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--help" || argument == "-h") {
      options.help = true;
      return options;
    }
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const auto row = optionTable().find(name);
    if (row != optionTable().end()) {
      const bool joined = equals != std::string::npos;
      if (!joined && i + 1 == arguments.size()) throw InputError(fmt::format("{}: its value is missing", name));
      row->second(options, name, joined ? argument.substr(equals + 1) : arguments[++i]);
    } else if (argument.size() > 1 && argument[0] == '-') {
      throw InputError(fmt::format("{}: unknown option; --help lists them", name));
    } else if (!options.config.empty()) {
      throw InputError(fmt::format("'{}': there is a configuration already, {}", argument, options.config));
    } else {
      options.config = argument;
    }
  }
  if (options.config.empty()) throw InputError("CONFIG.yaml is missing; --help says more");
  return options;
}

}  // namespace blem_sim
