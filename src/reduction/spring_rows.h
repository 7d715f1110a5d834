// Room of the weights of springs.
#pragma once

#include <cstddef>
#include <vector>

namespace blem_sim::reduction {

constexpr int SPRING_DIRECTIONS = 96;  // so many that each corner of a rectangle has a fifth of them, however it is turned

struct alignas(64) SpringRow {
  double of[SPRING_DIRECTIONS];  ///< by direction
};

struct SpringRoom {
  std::vector<SpringRow> prominence;  ///< per contact: its heights, as powers of e; the largest of a direction is 1
  std::vector<double> alike;
  std::vector<std::size_t> leaders;  ///< the first contacts of each normal
  std::vector<SpringRow> inverses;   ///< per leader: inverse sum of its patch's prominence
};

}  // namespace blem_sim::reduction
