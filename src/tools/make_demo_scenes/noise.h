// Random numbers that are the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>

namespace blem_sim::demo {

/** Splitmix64 with uniform and nearly normal numbers; only sums and products, so that no library's rounding shows. */
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}

  /** Uniform number in [0, 1). */
  double uniform() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
  }

  /** Nearly normal number of mean 0, standard deviation 1: the sum of twelve uniform numbers. */
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace blem_sim::demo
