// Entries of a configuration by joint.
#pragma once

#include <map>
#include <string>

namespace blem_sim::sim {

/** The entry that holds for a joint: its own, else "default"; null if there is neither. */
template <typename Value>
const Value* entryOf(const std::map<std::string, Value>& entries, const std::string& joint) {
  for (const std::string& key : {joint, std::string("default")}) {
    const auto entry = entries.find(key);
    if (entry != entries.end()) return &entry->second;
  }
  return nullptr;
}

/** The same as a value, or `otherwise`. */
template <typename Value>
Value byJoint(const std::map<std::string, Value>& entries, const std::string& joint, const Value& otherwise) {
  const Value* entry = entryOf(entries, joint);
  return entry ? *entry : otherwise;
}

}  // namespace blem_sim::sim
