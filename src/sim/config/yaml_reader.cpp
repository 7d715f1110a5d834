#include "config/yaml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"
#include "blem_sim/sim/rates.h"
#include "numbers/nearest_name.h"

namespace blem_sim::sim {

namespace {

/** "file:12", or "file" where a node was not read from a file (parameters of the node, --set). */
std::string place(const std::string& source, const YAML::Node& node) {
  const YAML::Mark mark = node.Mark();
  if (mark.is_null() || (mark.line == 0 && mark.column == 0)) return source;
  return fmt::format("{}:{}", source, mark.line + 1);
}

const char* kind(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  return node.IsNull() ? "nothing" : "a text";
}

// YAML's readers take off for a text or for false, whichever they were made for.
bool isOff(const YAML::Node& node) {
  static const std::set<std::string> WORDS = {"off", "Off", "OFF", ".off", "false", "False"};
  return node.IsScalar() && WORDS.count(node.Scalar()) > 0;
}

std::string quoted(const YAML::Node& node) { return node.IsScalar() ? "'" + node.Scalar() + "'" : kind(node); }

}  // namespace

YamlReader::YamlReader(const YAML::Node& node, const std::string& source, std::set<std::string>* log)
    : node_(node), source_(source), log_(log) {
  checkMap();
}

YamlReader::YamlReader(const YAML::Node& node, const YamlReader& parent, const std::string& path, const std::string& pattern)
    : node_(node), source_(parent.source_), path_(path), pattern_(pattern), log_(parent.log_) {
  checkMap();
}

void YamlReader::checkMap() const {
  if (!node_.IsDefined() || node_.IsNull()) return;
  if (!node_.IsMap()) refuse("", fmt::format("must be a map of keys, not {}", quoted(node_)));
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) refuse("", "a key must be a word");
    if (!seen.insert(entry.first.Scalar()).second) refuse(entry.first.Scalar(), "given twice; keep one");
  }
}

YAML::Node YamlReader::lookUp(const std::string& key) const {
  if (!node_.IsDefined() || !node_.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
  const YAML::Node& map = node_;
  return map[key];
}

YAML::Node YamlReader::node(const std::string& key) {
  if (!names_) {
    known_.push_back(key);
    if (log_) log_->insert(pattern_.empty() ? key : pattern_ + "." + key);
  }
  const YAML::Node found = lookUp(key);
  return found.IsDefined() && !found.IsNull() ? found : YAML::Node(YAML::NodeType::Undefined);
}

bool YamlReader::has(const std::string& key) { return node(key).IsDefined(); }

std::string YamlReader::pathOf(const std::string& key) const { return path_.empty() || key.empty() ? path_ + key : path_ + "." + key; }

void YamlReader::refuse(const std::string& key, const std::string& why) const {
  const YAML::Node value = key.empty() ? YAML::Node(YAML::NodeType::Undefined) : lookUp(key);
  const std::string path = pathOf(key);
  throw InputError(
      geometry::oneLine(fmt::format("{}: {}{}{}", place(source_, value.IsDefined() ? value : node_), path, path.empty() ? "" : ": ", why)));
}

void YamlReader::finish() const {
  if (names_ || !node_.IsDefined() || !node_.IsMap()) return;
  for (const auto& entry : node_) {
    const std::string& key = entry.first.Scalar();
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    refuse(key, fmt::format("unknown key; the nearest known one is '{}'", nearestName(key, known_)));
  }
}

std::string YamlReader::scalar(const std::string& key, const YAML::Node& node, const std::string& wanted) const {
  if (!node.IsScalar()) refuse(key, fmt::format("must be {}, not {}", wanted, kind(node)));
  return node.Scalar();
}

double YamlReader::number(const std::string& key, const YAML::Node& node, const NumberRange& range) const {
  scalar(key, node, range.words);
  double value = std::numeric_limits<double>::quiet_NaN();
  const bool is_number = YAML::convert<double>::decode(node, value);
  const bool inside = value <= range.upper && (range.open ? value > range.lower : value >= range.lower);
  if (!is_number || !inside) refuse(key, fmt::format("must be {}, not {}", range.words, quoted(node)));
  return value;
}

void YamlReader::read(const std::string& key, std::string* value) {
  if (const YAML::Node found = node(key); found.IsDefined()) *value = scalar(key, found, "a text");
}

void YamlReader::read(const std::string& key, bool* value) {
  const YAML::Node found = node(key);
  if (!found.IsDefined()) return;
  scalar(key, found, "true or false");
  if (!YAML::convert<bool>::decode(found, *value)) refuse(key, fmt::format("must be true or false, not {}", quoted(found)));
}

void YamlReader::read(const std::string& key, std::optional<bool>* value) {
  if (!node(key).IsDefined()) return;
  bool given = false;
  read(key, &given);
  *value = given;
}

void YamlReader::read(const std::string& key, double* value, const NumberRange& range) {
  if (const YAML::Node found = node(key); found.IsDefined()) *value = number(key, found, range);
}

void YamlReader::read(const std::string& key, std::optional<double>* value, const NumberRange& range) {
  if (const YAML::Node found = node(key); found.IsDefined()) *value = number(key, found, range);
}

void YamlReader::readRate(const std::string& key, double* value) {
  NumberRange range = NumberRange::notNegative();
  range.words = "a finite number of at least 0, or off";
  if (const YAML::Node found = node(key); found.IsDefined()) *value = isOff(found) ? RATE_OFF : number(key, found, range);
}

void YamlReader::read(const std::string& key, std::optional<int>* value, int lower, const char* words) {
  const YAML::Node found = node(key);
  if (!found.IsDefined()) return;
  const NumberRange range{static_cast<double>(lower), std::numeric_limits<int>::max(), false, words};
  const double given = number(key, found, range);
  if (given != std::floor(given)) refuse(key, fmt::format("must be {}, not {}", words, quoted(found)));
  *value = static_cast<int>(given);
}

void YamlReader::read(const std::string& key, int* value, int lower) {
  std::optional<int> given;
  read(key, &given, lower);
  if (given) *value = *given;
}

void YamlReader::read(const std::string& key, std::uint64_t* value) {
  const YAML::Node found = node(key);
  if (!found.IsDefined()) return;
  const std::string text = scalar(key, found, "a whole number of at least 0");
  // Decoding "-1" into an unsigned number would wrap around.
  if (text.find_first_not_of("0123456789") != std::string::npos || !YAML::convert<std::uint64_t>::decode(found, *value))
    refuse(key, fmt::format("must be a whole number of at least 0, not {}", quoted(found)));
}

std::optional<std::vector<double>> YamlReader::numbers(const std::string& key, std::size_t count) {
  const YAML::Node found = node(key);
  if (!found.IsDefined()) return std::nullopt;
  if (!found.IsSequence() || found.size() != count)
    refuse(key, fmt::format("must be a list of {} numbers, not {}", count,
                            found.IsSequence() ? fmt::format("of {}", found.size()) : quoted(found)));
  std::vector<double> values;
  for (const auto& item : found) values.push_back(number(key, item, NumberRange::any()));
  return values;
}

void YamlReader::read(const std::string& key, std::optional<Vector3>* value) {
  if (const auto given = numbers(key, 3)) *value = Vector3((*given)[0], (*given)[1], (*given)[2]);
}

void YamlReader::read(const std::string& key, Vector3* value) {
  std::optional<Vector3> given;
  read(key, &given);
  if (given) *value = *given;
}

void YamlReader::read(const std::string& key, Pose* value) {
  YamlReader pose = section(key);
  Vector3 xyz = Vector3::Zero(), rpy = Vector3::Zero();
  pose.read("xyz", &xyz);
  pose.read("rpy", &rpy);
  pose.finish();
  if (has(key)) *value = makePose(xyz, rpy);
}

std::optional<int> YamlReader::choice(const std::string& key, const std::vector<std::string>& names) {
  const YAML::Node found = node(key);
  if (!found.IsDefined()) return std::nullopt;
  const auto name = std::find(names.begin(), names.end(), scalar(key, found, "a word"));
  if (name == names.end()) refuse(key, fmt::format("must be one of {}, not {}", fmt::join(names, ", "), quoted(found)));
  return static_cast<int>(name - names.begin());
}

YamlReader YamlReader::section(const std::string& key) {
  const std::string pattern = names_ ? pattern_ + ".*" : (pattern_.empty() ? key : pattern_ + "." + key);
  return YamlReader(node(key), *this, pathOf(key), pattern);
}

void YamlReader::forEachItem(const std::string& key, const std::function<void(YamlReader&)>& visit) {
  const YAML::Node list = node(key);
  if (!list.IsDefined()) return;
  if (!list.IsSequence()) refuse(key, fmt::format("must be a list, not {}", quoted(list)));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const YAML::Node& items = list;
    YamlReader item(items[i], *this, fmt::format("{}[{}]", pathOf(key), i), (pattern_.empty() ? key : pattern_ + "." + key) + "[]");
    visit(item);
    item.finish();
  }
}

void YamlReader::forEachName(const std::string& key, const std::function<void(const std::string&, YamlReader&)>& visit) {
  YamlReader map = section(key);
  map.names_ = true;
  if (!map.node_.IsDefined()) return;
  std::set<std::string> names;
  for (const auto& entry : map.node_) names.insert(entry.first.Scalar());
  for (const std::string& name : names) visit(name, map);
}

}  // namespace blem_sim::sim
