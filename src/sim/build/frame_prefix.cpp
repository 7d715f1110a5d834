#include "build/frame_prefix.h"

#include <fmt/format.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::sim {
namespace {

std::string withoutOuterSlashes(const std::string& prefix) {
  const std::size_t first = prefix.find_first_not_of('/'), last = prefix.find_last_not_of('/');
  return first == std::string::npos ? "" : prefix.substr(first, last - first + 1);
}

/** A link's name that both robots have; none if they share none but that of the world. */
std::string sharedLink(const model::RobotModel& a, const model::RobotModel& b) {
  const auto shared = [&](const model::LinkModel& link) { return link.name != "world" && b.linkIndex(link.name) >= 0; };
  const auto found = std::find_if(a.links.begin(), a.links.end(), shared);
  return found == a.links.end() ? "" : found->name;
}

/** The robot that has frames of the same name; null if there is none. */
const RobotInfo* rivalOf(const std::string& prefix, const model::RobotModel& model, const std::vector<RobotInfo>& others) {
  const auto rivals = [&](const RobotInfo& other) { return other.tf_prefix == prefix && !sharedLink(model, *other.description).empty(); };
  const auto found = std::find_if(others.begin(), others.end(), rivals);
  return found == others.end() ? nullptr : &*found;
}

}  // namespace

std::string framePrefix(const RobotConfig& config, const model::RobotModel& model, const std::vector<RobotInfo>& others,
                        std::vector<std::string>* notes) {
  const std::string given = withoutOuterSlashes(config.tf_prefix);
  const RobotInfo* const rival = rivalOf(given, model, others);
  if (!rival) return given;
  const std::string link = sharedLink(model, *rival->description);
  if (const RobotInfo* const second = rivalOf(config.name, model, others))
    throw InputError(fmt::format("robots: {}: tf_prefix: '{}' and '{}' have a link '{}' too, and prefixes '{}' and '{}'; give another one",
                                 config.name, rival->name, second->name, link, rival->tf_prefix, second->tf_prefix));
  notes->push_back(fmt::format("'{}' has a link '{}' too, so the frames of '{}' begin with '{}/'; set tf_prefix to choose another",
                               rival->name, link, config.name, config.name));
  return config.name;
}

}  // namespace blem_sim::sim
