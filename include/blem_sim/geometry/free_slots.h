// Lists of slots: items that were taken out leave their place to the next ones.
#pragma once

#include <set>

namespace blem_sim::geometry {

/** Takes the lowest free slot, else a new one at the end. @param free slots of `items` that nobody has @return the slot */
template <typename Items>
int takeSlot(std::set<int>* free, Items* items) {
  if (free->empty()) {
    items->emplace_back();
    return static_cast<int>(items->size()) - 1;
  }
  const int slot = *free->begin();
  free->erase(free->begin());
  return slot;
}

}  // namespace blem_sim::geometry
