// Random choices for scenes, the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>

#include "blem_sim/geometry/types.h"
#include "numbers/random_numbers.h"

namespace blem_sim {

class SceneNumbers {
 public:
  explicit SceneNumbers(std::uint64_t seed) : numbers_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * numbers_.uniform(); }
  /** A number from low to high, uniform in the logarithm. */
  double spread(double low, double high) { return low * std::pow(high / low, numbers_.uniform()); }
  /** A whole number from low to high, both included. */
  int count(int low, int high) { return low + static_cast<int>(numbers_.next() % static_cast<std::uint64_t>(high - low + 1)); }
  bool chance(double probability) { return numbers_.uniform() <= probability; }
  Vector3 direction() {
    const Vector3 v = numbers_.gaussianVector();
    return v.norm() > 0 ? Vector3(v.normalized()) : Vector3::UnitX();
  }
  Vector3 within(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
    return {x, y, z};
  }

 private:
  sim::RandomNumbers numbers_;
};

}  // namespace blem_sim
