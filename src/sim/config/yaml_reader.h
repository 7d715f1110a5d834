// Reads one map of a configuration key by key, and refuses keys that nobody asked for.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::sim {

/** Numbers that a key takes. */
struct NumberRange {
  double lower = -std::numeric_limits<double>::max(), upper = std::numeric_limits<double>::max();
  bool open = false;  ///< lower itself is refused
  const char* words = "a finite number";

  static NumberRange any() { return {}; }
  static NumberRange positive() { return {0, std::numeric_limits<double>::max(), true, "a finite number above 0"}; }
  static NumberRange notNegative() { return {0, std::numeric_limits<double>::max(), false, "a finite number of at least 0"}; }
  static NumberRange notPositive() { return {-std::numeric_limits<double>::max(), 0, false, "a finite number of at most 0"}; }
  static NumberRange positiveOrInfinite() { return {0, std::numeric_limits<double>::infinity(), true, "a number above 0, or .inf"}; }
  static NumberRange notNegativeOrInfinite() {
    return {0, std::numeric_limits<double>::infinity(), false, "a number of at least 0, or .inf"};
  }
  /** Deviations and biases of readings, in their units: beyond that a number is a slip, and readings are noise alone. */
  static NumberRange deviation() { return {0, 1e7, false, "a number from 0 to 1e7"}; }
  static NumberRange bias() { return {-1e7, 1e7, false, "a number from -1e7 to 1e7"}; }
  static NumberRange fraction() { return {0, 1, false, "a number from 0 to 1"}; }
};

/**
 * One map (or nothing, which is a map without keys) of a YAML document. Every key that is asked for counts as known; finish() refuses the
 * others. All functions throw InputError with one line: file:line, path of the key, cure.
 */
class YamlReader {
 public:
  /** @param log if given, receives every key asked for, as "robots[].gains.*.p" @throws InputError if the node is no map or repeats a key
   */
  YamlReader(const YAML::Node& node, const std::string& source, std::set<std::string>* log = nullptr);

  bool has(const std::string& key);
  void read(const std::string& key, std::string* value);
  void read(const std::string& key, bool* value);
  void read(const std::string& key, std::optional<bool>* value);
  void read(const std::string& key, double* value, const NumberRange& range);
  void read(const std::string& key, std::optional<double>* value, const NumberRange& range);
  void read(const std::string& key, int* value, int lower);
  /** @param words what the number must be, in messages */
  void read(const std::string& key, std::optional<int>* value, int lower, const char* words = "a whole number");
  void read(const std::string& key, std::uint64_t* value);
  void read(const std::string& key, Vector3* value);
  void read(const std::string& key, std::optional<Vector3>* value);
  /** A rate [Hz]; off, .off or false reads as RATE_OFF. */
  void readRate(const std::string& key, double* value);
  /** A map {xyz: [m], rpy: [rad]}, both optional. */
  void read(const std::string& key, Pose* value);
  /** @return index into `names` of the text given, or nothing */
  std::optional<int> choice(const std::string& key, const std::vector<std::string>& names);
  /** A list of exactly `count` finite numbers; nothing if the key is absent. */
  std::optional<std::vector<double>> numbers(const std::string& key, std::size_t count);

  /** The map under a key; nothing under it reads as an empty map. */
  YamlReader section(const std::string& key);
  /** Each map of the list under a key. */
  void forEachItem(const std::string& key, const std::function<void(YamlReader&)>& visit);
  /** Each entry of the map under a key whose keys are names: visit(name, the map that holds it), for visit to read the name from. */
  void forEachName(const std::string& key, const std::function<void(const std::string&, YamlReader&)>& visit);
  /** The node under a key, known from now on. */
  YAML::Node node(const std::string& key);

  /** @throws InputError for a key that nobody asked for, with the nearest known one */
  void finish() const;
  /** Refuses a key (an empty one: the map itself). */
  [[noreturn]] void refuse(const std::string& key, const std::string& why) const;

 private:
  YamlReader(const YAML::Node& node, const YamlReader& parent, const std::string& path, const std::string& pattern);
  void checkMap() const;
  YAML::Node lookUp(const std::string& key) const;
  std::string scalar(const std::string& key, const YAML::Node& node, const std::string& wanted) const;
  double number(const std::string& key, const YAML::Node& node, const NumberRange& range) const;
  std::string pathOf(const std::string& key) const;

  YAML::Node node_;
  std::string source_, path_, pattern_;
  bool names_ = false;  ///< keys are free names
  std::vector<std::string> known_;
  std::set<std::string>* log_;
};

}  // namespace blem_sim::sim
