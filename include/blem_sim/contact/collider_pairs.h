// Lists of things that belong to pairs of colliders, sorted by (a, b).
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "blem_sim/contact/collider.h"

namespace blem_sim {

/** The item of the pair (a, b), a < b; null if there is none. Precondition: items sorted by (a, b). */
template <typename Item>
const Item* findPair(const std::vector<Item>& items, int a, int b) {
  const auto at = std::lower_bound(items.begin(), items.end(), std::make_pair(a, b),
                                   [](const Item& item, const auto& pair) { return std::make_pair(item.a, item.b) < pair; });
  return at != items.end() && at->a == a && at->b == b ? &*at : nullptr;
}

/** Are these words of a saved state the pair (a, b), a < b, of two colliders that are there? */
inline bool isPair(const std::vector<Collider>& colliders, std::uint64_t a, std::uint64_t b) {
  return a < b && b < colliders.size() && colliders[a].enabled && colliders[b].enabled;
}

/** Does each pair of a list come after the one before it? */
template <typename Item>
bool areSorted(const std::vector<Item>& items) {
  const auto follows = [](const Item& p, const Item& q) { return std::make_pair(q.a, q.b) <= std::make_pair(p.a, p.b); };
  return std::adjacent_find(items.begin(), items.end(), follows) == items.end();
}

/** Takes the pairs of one collider out of a list. */
template <typename Item>
void removePairsOf(int collider, std::vector<Item>* items) {
  const auto has_it = [&](const Item& item) { return item.a == collider || item.b == collider; };
  items->erase(std::remove_if(items->begin(), items->end(), has_it), items->end());
}

}  // namespace blem_sim
