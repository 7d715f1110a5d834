#include "gazebo/gazebo_names.h"

#include <cctype>

namespace blem_sim::sim {
namespace {

bool isWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

}  // namespace

std::string rosWord(std::string name, const std::string& prefix) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !isWord(c); }, '_');
  const bool begins_well = !name.empty() && std::isalpha(static_cast<unsigned char>(name.front()));
  return begins_well ? name : prefix + name;
}

bool isTopic(const std::string& topic) {
  const bool begins_well = std::isalpha(static_cast<unsigned char>(topic.front())) || topic.front() == '/';
  return begins_well && std::all_of(topic.begin(), topic.end(), [](char c) { return isWord(c) || c == '/'; });
}

std::string withoutDoubleSlashes(std::string topic) {
  const auto twice = [](char a, char b) { return a == '/' && b == '/'; };
  topic.erase(std::unique(topic.begin(), topic.end(), twice), topic.end());
  return topic;
}

std::string resolvedTopic(const std::string& name_space, const std::string& topic) {
  const bool absolute = !topic.empty() && topic.front() == '/';
  return withoutDoubleSlashes(absolute ? topic : "/" + name_space + "/" + topic);
}

std::string topicInBlock(const std::string& topic, const std::string& given, const std::string& robots) {
  const bool is_own = !topic.empty() && topic.front() != '/' && robots.empty() && !given.empty();
  return withoutDoubleSlashes(is_own ? "/" + given + "/" + topic : topic);
}

}  // namespace blem_sim::sim
