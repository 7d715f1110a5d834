// A list that several threads fill.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace blem_sim::geometry {

/** Lists, one behind the other. */
template <typename T>
std::vector<T> concatenated(std::vector<std::vector<T>> lists) {
  if (lists.size() == 1) return std::move(lists.front());
  std::vector<std::size_t> begin(lists.size() + 1, 0);
  for (std::size_t i = 0; i < lists.size(); ++i) begin[i + 1] = begin[i] + lists[i].size();
  std::vector<T> all(begin.back());
  tbb::parallel_for(std::size_t{0}, lists.size(), [&](std::size_t i) {
    std::copy(lists[i].begin(), lists[i].end(), all.begin() + static_cast<std::ptrdiff_t>(begin[i]));
    std::vector<T>().swap(lists[i]);
  });
  return all;
}

/** A list to which append(item, &list) has added for each of `count` items, in their order. */
template <typename T, typename Append>
std::vector<T> collected(int count, Append&& append) {
  constexpr int ITEMS = 1 << 14;
  std::vector<std::vector<T>> lists(static_cast<std::size_t>(count / ITEMS) + 1);
  tbb::parallel_for(std::size_t{0}, lists.size(), [&](std::size_t list) {
    const int begin = static_cast<int>(list) * ITEMS, end = begin + std::min(count - begin, ITEMS);
    for (int item = begin; item < end; ++item) append(item, &lists[list]);
  });
  return concatenated(std::move(lists));
}

}  // namespace blem_sim::geometry
