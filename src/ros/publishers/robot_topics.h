// Topics that come and go with what they belong to, while the others' stay.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace blem_sim::node {

/**
 * Makes `topics` go with `owners`, one each in the same order: those that are there already are kept, by their key. If
 * `make` throws, `topics` stays as it was.
 * @param keyOf key of an owner; a topic has its owner's in a member `key` @param make a topic of an owner, without its key
 */
template <typename Topic, typename Owner, typename KeyOf, typename Make>
void keepTopics(const std::vector<Owner>& owners, const KeyOf& keyOf, const Make& make, std::vector<Topic>* topics) {
  const auto knownOf = [&](const Owner& owner) {
    return std::find_if(topics->begin(), topics->end(), [&](const Topic& topic) { return topic.key == keyOf(owner); });
  };
  std::vector<Topic> made, kept;
  for (const Owner& owner : owners) {
    if (knownOf(owner) != topics->end()) continue;
    made.push_back(make(owner));
    made.back().key = keyOf(owner);
  }
  auto next_made = made.begin();
  for (const Owner& owner : owners) {
    const auto known = knownOf(owner);
    kept.push_back(std::move(known != topics->end() ? *known : *next_made++));
    kept.back().key = keyOf(owner);
  }
  topics->swap(kept);
}

}  // namespace blem_sim::node
