// A counting sort that several threads share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "blem_sim/geometry/for_all.h"

namespace blem_sim::geometry {

/** Turns counts at [i + 1] into the beginnings of groups. */
inline void accumulate(std::vector<int>* counts) {
  for (std::size_t i = 1; i < counts->size(); ++i) (*counts)[i] += (*counts)[i - 1];
}

/**
 * Puts values into groups; within one they are in the order of their items.
 * @param visitValues called as visitValues(item, visit) calls visit(group, value) for each value of the item, the same ones each time
 * @param makeRoom called with the number of all values, gives their place @return beginning of each group, and the end of the last
 */
template <typename VisitValues, typename MakeRoom>
std::vector<int> grouped(int items, int groups, VisitValues&& visitValues, MakeRoom&& makeRoom) {
  constexpr int MANY = 1 << 14;
  const int parts = items < MANY ? 1 : 4;
  const auto first = [&](int part) { return static_cast<int>(static_cast<long long>(items) * part / parts); };
  // Per part, first the number of values that each group gets, then the place of its next one.
  std::vector<std::unique_ptr<int[]>> next(static_cast<std::size_t>(parts));
  const auto countPart = [&](int part) {
    next[part] = std::make_unique<int[]>(static_cast<std::size_t>(groups));
    int* const counts = next[part].get();
    for (int i = first(part); i < first(part + 1); ++i) visitValues(i, [counts](int group, auto) { ++counts[group]; });
  };
  forAll(parts, countPart, 1);
  std::vector<int> begin(static_cast<std::size_t>(groups) + 1);
  int total = 0;
  for (int group = 0; group < groups; ++group) {
    begin[group] = total;
    for (const auto& of_part : next) {
      const int count = of_part[group];
      of_part[group] = total;
      total += count;
    }
  }
  begin[groups] = total;
  auto* const values = makeRoom(static_cast<std::size_t>(total));
  const auto placePart = [&](int part) {
    int* const places = next[part].get();
    for (int i = first(part); i < first(part + 1); ++i) visitValues(i, [=](int group, auto value) { values[places[group]++] = value; });
  };
  forAll(parts, placePart, 1);
  return begin;
}

}  // namespace blem_sim::geometry
