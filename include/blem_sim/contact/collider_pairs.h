// Lists of things that belong to pairs of colliders, sorted by (a, b).
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/geometry/state_stream.h"

namespace blem_sim::contact {

/** The order of pairs: by a, then by b. */
struct IsPairBefore {
  template <typename P, typename Q>
  bool operator()(const P& p, const Q& q) const {
    return std::make_pair(p.a, p.b) < std::make_pair(q.a, q.b);
  }
};

/** The item of the pair (a, b), a < b; null if there is none. Precondition: items sorted by (a, b). */
template <typename Item>
const Item* findPair(const std::vector<Item>& items, int a, int b) {
  const auto at = std::lower_bound(items.begin(), items.end(), std::make_pair(a, b),
                                   [](const Item& item, const auto& pair) { return std::make_pair(item.a, item.b) < pair; });
  return at != items.end() && at->a == a && at->b == b ? &*at : nullptr;
}

/** Refuses a saved state whose memories are of other pairs. */
[[noreturn]] inline void refusePairs(const geometry::StateReader& reader) {
  reader.refuseContent("memories of contacts are of no pairs of these colliders");
}

/** Two words of a saved state that name two slots of colliders, in order; others are refused. */
inline std::pair<int, int> readSlots(const std::vector<Collider>& colliders, geometry::StateReader* reader) {
  const std::uint64_t a = reader->word(), b = reader->word();
  if (a >= b || b >= colliders.size()) refusePairs(*reader);
  return {static_cast<int>(a), static_cast<int>(b)};
}

/** The same for two colliders that are there. */
inline std::pair<int, int> readPair(const std::vector<Collider>& colliders, geometry::StateReader* reader) {
  const std::pair<int, int> pair = readSlots(colliders, reader);
  if (!colliders[static_cast<std::size_t>(pair.first)].enabled || !colliders[static_cast<std::size_t>(pair.second)].enabled)
    refusePairs(*reader);
  return pair;
}

/** Whether every pair of a list comes after the one before it, none twice. */
template <typename Item>
bool areSorted(const std::vector<Item>& items) {
  const auto is_not_before = [](const Item& p, const Item& q) { return !IsPairBefore()(p, q); };
  return std::adjacent_find(items.begin(), items.end(), is_not_before) == items.end();
}

/** Takes the pairs of one collider out of a list. */
template <typename Item>
void removePairsOf(int collider, std::vector<Item>* items) {
  const auto has_it = [&](const Item& item) { return item.a == collider || item.b == collider; };
  items->erase(std::remove_if(items->begin(), items->end(), has_it), items->end());
}

}  // namespace blem_sim::contact
