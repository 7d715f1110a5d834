// Command lines of the programs: options with and without values, in any order.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim {

/** Takes the value of an option into the program's options. @throws InputError for a malformed value */
template <class Options>
using TakeValue = std::function<void(Options&, const std::string& option, const std::string& value)>;

/** Options with values: a new one is one row. */
template <class Options>
using OptionTable = std::map<std::string, TakeValue<Options>>;

/** Options without a value: those that are given become true. */
template <class Options>
using FlagTable = std::map<std::string, bool Options::*>;

/** @throws InputError unless `text` is a finite number of at least 0 */
double numberOf(const std::string& option, const std::string& text);

/** @throws InputError for an empty text, as scripts make of variables that are not set */
std::string textOf(const std::string& option, const std::string& text);

/** @return NAME, VALUE @throws InputError unless `text` is NAME=VALUE */
std::pair<std::string, std::string> assignment(const std::string& option, const std::string& text);

template <class Options>
TakeValue<Options> text(std::string Options::*field) {
  return [field](Options& options, const std::string& option, const std::string& value) { options.*field = textOf(option, value); };
}

template <class Options>
TakeValue<Options> number(double Options::*field) {
  return [field](Options& options, const std::string& option, const std::string& value) { options.*field = numberOf(option, value); };
}

/**
 * Reads a command line. --help or -h sets options->help and ends it.
 * @return arguments that are no options, in order @throws InputError for an unknown option, a missing or malformed value
 */
template <class Options>
std::vector<std::string> readArguments(const std::vector<std::string>& arguments, const OptionTable<Options>& table,
                                       const FlagTable<Options>& flags, Options* options) {
  std::vector<std::string> others;
  for (std::size_t i = 0; i < arguments.size() && !options->help; ++i) {
    const std::string& argument = arguments[i];
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const auto row = table.find(name);
    const auto flag = flags.find(argument);
    if (argument == "--help" || argument == "-h") {
      options->help = true;
    } else if (flag != flags.end()) {
      options->*(flag->second) = true;
    } else if (row != table.end()) {
      const bool joined = equals != std::string::npos;
      if (!joined && i + 1 == arguments.size()) throw InputError(fmt::format("{}: its value is missing", name));
      row->second(*options, name, joined ? argument.substr(equals + 1) : arguments[++i]);
    } else if (argument.size() > 1 && argument[0] == '-') {
      throw InputError(fmt::format("{}: unknown option; --help lists them", name));
    } else {
      others.push_back(argument);
    }
  }
  return others;
}

}  // namespace blem_sim
