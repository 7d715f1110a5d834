#include "numbers/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"

namespace blem_sim::sim {
namespace {

constexpr std::size_t LONGEST_NAME = 200;  // characters that are compared and told

int editDistance(const std::string& a, const std::string& b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string shownName(const std::string& name) { return geometry::oneLine(name.substr(0, LONGEST_NAME)); }

std::string nearestName(const std::string& given, const std::vector<std::string>& known) {
  const std::string name = given.substr(0, LONGEST_NAME);
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
    return editDistance(name, a) < editDistance(name, b);
  });
  return nearest == known.end() ? std::string() : *nearest;
}

void requireName(const std::string& given, const std::vector<std::string>& known, const std::string& where, const std::string& kind) {
  if (std::find(known.begin(), known.end(), given) != known.end()) return;
  const std::string name = shownName(given);
  if (known.empty()) throw InputError(fmt::format("{}: no {} '{}'; there is none at all", where, kind, name));
  throw InputError(fmt::format("{}: no {} '{}'; the nearest is '{}'", where, kind, name, nearestName(name, known)));
}

}  // namespace blem_sim::sim
