#include "overrides.h"

#include <fmt/format.h>

#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/config.h"

namespace blem_sim {

namespace {

/** "robots[0].name" and "robots.0.name" are the same three steps. */
std::vector<std::string> splitPath(const std::string& path) {
  std::vector<std::string> steps(1);
  for (const char letter : path) {
    if (letter == '.' || letter == '[')
      steps.emplace_back();
    else if (letter != ']')
      steps.back() += letter;
  }
  for (const std::string& step : steps)
    if (step.empty()) throw InputError(fmt::format("--set {}: an empty step in the path", path));
  return steps;
}

std::size_t itemIndex(const std::string& path, const std::string& step, std::size_t count) {
  const bool digits = step.find_first_not_of("0123456789") == std::string::npos && step.size() < 9;
  if (!digits || std::stoul(step) >= count)
    throw InputError(fmt::format("--set {}: '{}' is no item of a list of {}; items are numbered from 0", path, step, count));
  return std::stoul(step);
}

// By value: assigning to a YAML::Node that is a reference into the tree would replace the tree's node.
void set(YAML::Node node, const std::string& path, const std::vector<std::string>& steps, std::size_t at, const YAML::Node& value) {
  const bool last = at + 1 == steps.size();
  if (node.IsSequence()) {
    const std::size_t index = itemIndex(path, steps[at], node.size());
    if (last)
      node[index] = value;
    else
      set(node[index], path, steps, at + 1, value);
    return;
  }
  if (node.IsScalar()) throw InputError(fmt::format("--set {}: there is nothing below '{}', which is a value", path, steps[at - 1]));
  if (last) {
    node[steps[at]] = value;
    return;
  }
  if (!node[steps[at]].IsDefined() || node[steps[at]].IsNull()) node[steps[at]] = YAML::Node(YAML::NodeType::Map);
  set(node[steps[at]], path, steps, at + 1, value);
}

}  // namespace

void overrideSetting(YAML::Node* root, const std::string& path, const std::string& value) {
  YAML::Node node;
  try {
    // A clone carries no line numbers, which would be taken for the file's.
    node = YAML::Clone(sim::loadYaml(value));
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("--set {}: '{}' is not YAML: {}", path, value, error.msg));
  }
  if (root->IsNull()) *root = YAML::Node(YAML::NodeType::Map);
  if (!root->IsMap()) throw InputError(fmt::format("--set {}: the configuration is not a map", path));
  set(*root, path, splitPath(path), 0, node);
}

}  // namespace blem_sim
