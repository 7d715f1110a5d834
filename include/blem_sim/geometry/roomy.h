// Lists that are filled anew in every step.
#pragma once

#include <cstddef>

namespace blem_sim::geometry {

/** Makes room for `count` items, where there is less for twice as many, so that a list that was emptied does not ask for memory whenever it
 * is longer by one than it ever was. */
template <typename Items>
void makeRoomFor(std::size_t count, Items* items) {
  if (items->capacity() < count) items->reserve(2 * count);
}

/** resize, with such room. */
template <typename Items, typename... Item>
void resizeRoomy(std::size_t count, Items* items, const Item&... filled_with) {
  makeRoomFor(count, items);
  items->resize(count, filled_with...);
}

}  // namespace blem_sim::geometry
