#include "gazebo/gazebo_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

namespace blem_sim::sim {
namespace {

constexpr double NEARLY_ZERO = 1e-6;  // written where other programs refuse 0

}  // namespace

std::optional<std::string> GazeboReader::text(const std::string& path) {
  known_.insert(path);
  const auto named = [&](const model::GazeboValue& value) { return value.path == path; };
  const auto found = std::find_if(block_.values.begin(), block_.values.end(), named);
  return found == block_.values.end() ? std::nullopt : std::make_optional(found->text);
}

void GazeboReader::read(const std::string& path, std::string* value) {
  if (const auto given = text(path)) *value = *given;
}

std::optional<std::vector<double>> GazeboReader::numbers(const std::string& path, std::size_t count) {
  const auto given = text(path);
  if (!given) return std::nullopt;
  std::istringstream stream(*given);
  stream.imbue(std::locale::classic());
  std::vector<double> values;
  for (double value = 0; values.size() <= count && stream >> value;) values.push_back(value);
  const bool finite = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  if (values.size() == count && stream.eof() && finite) return values;
  fault(path, fmt::format("'{}' is not {}; it is left out: write {}", *given, count == 1 ? "a number" : fmt::format("{} numbers", count),
                          count == 1 ? "a plain number" : "plain numbers"));
  return std::nullopt;
}

void GazeboReader::read(const std::string& path, std::optional<double>* value, const NumberRange& range) {
  const auto given = numbers(path, 1);
  if (!given) return;
  const double number = given->front();
  if (number <= range.upper && (range.open ? number > range.lower : number >= range.lower))
    *value = number;
  else
    fault(path, fmt::format("is {:g}; it is left out: give {}", number, range.words));
}

void GazeboReader::read(const std::string& path, double* value, const NumberRange& range) {
  std::optional<double> number;
  read(path, &number, range);
  *value = number.value_or(*value);
}

void GazeboReader::read(const std::string& path, int* value, const NumberRange& range) {
  double number = *value;
  read(path, &number, range);
  if (number == std::floor(number) && std::abs(number) <= std::numeric_limits<int>::max())
    *value = static_cast<int>(number);
  else
    fault(path, fmt::format("is {:g}; it is left out: give a whole number", number));
}

void GazeboReader::read(const std::string& path, std::optional<bool>* value) {
  const auto given = text(path);
  if (!given) return;
  if (*given == "true" || *given == "1" || *given == "True")
    *value = true;
  else if (*given == "false" || *given == "0" || *given == "False")
    *value = false;
  else
    fault(path, fmt::format("'{}' is neither true nor false; it is left out: write one of them", *given));
}

void GazeboReader::read(const std::string& path, Vector3* value) {
  if (const auto given = numbers(path, 3)) *value = Vector3((*given)[0], (*given)[1], (*given)[2]);
}

void GazeboReader::read(const std::string& path, Pose* value) {
  if (const auto given = numbers(path, 6))
    *value = makePose({(*given)[0], (*given)[1], (*given)[2]}, {(*given)[3], (*given)[4], (*given)[5]});
}

bool GazeboReader::skipOne(const std::string& path) {
  const std::string inside = path + "/";
  bool any = false;
  for (const model::GazeboValue& value : block_.values) {
    if (value.path != path && value.path.compare(0, inside.size(), inside) != 0) continue;
    known_.insert(value.path);
    any = true;
  }
  return any;
}

void GazeboReader::skip(std::initializer_list<const char*> paths) {
  for (const char* path : paths) skipOne(path);
}

void GazeboReader::skipWithoutEffect(std::initializer_list<const char*> paths) {
  for (const char* path : paths)
    if (skipOne(path)) notes_.withoutEffect(path);
}

void GazeboReader::skipZeros(std::initializer_list<const char*> paths) {
  for (const char* path : paths) {
    double number = 0;
    read(path, &number, NumberRange::any());
    if (std::abs(number) > NEARLY_ZERO) notes_.unknown(where(), fmt::format("<{}>", path));
  }
}

void GazeboReader::finish() const {
  for (const model::GazeboValue& value : block_.values)
    if (known_.count(value.path) == 0) notes_.unknown(where(), fmt::format("<{}>", value.path));
}

void GazeboReader::fault(const std::string& path, const std::string& why) const {
  notes_.fault(where(), fmt::format("<{}>: {}", path, why));
}

std::string GazeboReader::where() const {
  if (block_.element == "gazebo") return block_.reference.empty() ? "the robot's" : fmt::format("'{}'", block_.reference);
  return fmt::format("{} '{}'", block_.element, block_.name.empty() ? block_.type : block_.name);
}

}  // namespace blem_sim::sim
