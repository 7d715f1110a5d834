// Random numbers of blem_sim's own: the same everywhere, and their whole state is one word.
#pragma once

#include <cmath>
#include <cstdint>

#include "blem_sim/geometry/types.h"

namespace blem_sim::sim {

/** splitmix64 [Steele 2014] and Box-Muller. */
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed = 0) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /** Uniform number in (0, 1]. */
  double uniform() { return (static_cast<double>(next() >> 11) + 1) * 0x1p-53; }
  /** Normal number of mean 0 and standard deviation 1. */
  double gaussian() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * M_PI * uniform());
  }
  Vector3 gaussianVector() {
    Vector3 v;
    for (int i = 0; i < 3; ++i) v[i] = gaussian();
    return v;
  }

  std::uint64_t state() const { return state_; }
  void setState(std::uint64_t state) { state_ = state; }

 private:
  std::uint64_t state_;
};

}  // namespace blem_sim::sim
