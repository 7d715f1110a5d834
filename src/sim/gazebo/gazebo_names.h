// Names in <gazebo> blocks as ROS takes them.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "numbers/nearest_name.h"

namespace blem_sim::sim {

/** A name that ROS takes in a topic. @param prefix of one that does not begin with a letter */
std::string rosWord(std::string name, const std::string& prefix);
/** @param topic not empty */
bool isTopic(const std::string& topic);
std::string withoutDoubleSlashes(std::string topic);
/** The whole name of a topic of a robot in a namespace. */
std::string resolvedTopic(const std::string& name_space, const std::string& topic);
/**
 * A topic of a block with a namespace of its own, which the robot's beats: two robots of one URDF have topics of their own.
 * @param given by the block; empty: none
 */
std::string topicInBlock(const std::string& topic, const std::string& given, const std::string& robots);

/** In words, a name that is not there, and the nearest among the first that are. */
template <typename Named>
std::string unknownName(const std::string& kind, const std::string& name, const std::vector<Named>& items) {
  constexpr std::size_t COMPARED_NAMES = 200;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(items.size(), COMPARED_NAMES); ++i) names.push_back(items[i].name);
  return fmt::format("there is no {} '{}' (the nearest is '{}')", kind, name, nearestName(name, names));
}

}  // namespace blem_sim::sim
