// Lists of things that belong to pairs of colliders, sorted by (a, b).
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace blem_sim {

/** The item of the pair (a, b), a < b; null if there is none. Precondition: items sorted by (a, b). */
template <typename Item>
const Item* findPair(const std::vector<Item>& items, int a, int b) {
  const auto at = std::lower_bound(items.begin(), items.end(), std::make_pair(a, b),
                                   [](const Item& item, const auto& pair) { return std::make_pair(item.a, item.b) < pair; });
  return at != items.end() && at->a == a && at->b == b ? &*at : nullptr;
}

}  // namespace blem_sim
