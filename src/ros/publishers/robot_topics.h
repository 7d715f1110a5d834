// Topics that come and go with what they belong to, while the others' stay.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace blem_sim::node {

/**
 * Makes `topics` go with `owners`, one each in the same order: those that are there already are kept, by their key.
 * @param keyOf key of an owner; a topic has its owner's in a member `key` @param make a topic of an owner, without its key
 */
template <typename Topic, typename Owner, typename KeyOf, typename Make>
void keepTopics(const std::vector<Owner>& owners, const KeyOf& keyOf, const Make& make, std::vector<Topic>* topics) {
  std::vector<Topic> kept;
  for (const Owner& owner : owners) {
    const auto key = keyOf(owner);
    const auto known = std::find_if(topics->begin(), topics->end(), [&](const Topic& topic) { return topic.key == key; });
    kept.push_back(known != topics->end() ? std::move(*known) : make(owner));
    kept.back().key = key;
  }
  topics->swap(kept);
}

}  // namespace blem_sim::node
