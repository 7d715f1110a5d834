// Hashes of positions and indices.
#pragma once

#include <cstdint>
#include <cstring>

#include "blem_sim/geometry/types.h"

namespace blem_sim::geometry {

/** The hash `h`, with some more bits in it. */
inline std::uint64_t hashedOn(std::uint64_t h, std::uint64_t bits) {
  h = (h ^ bits) * 0x9E3779B97F4A7C15u;
  return h ^ h >> 32;
}

/** Hash of a place's bits; -0.0 is 0.0. */
inline std::uint64_t placeHash(const Vector3& v) {
  std::uint64_t h = 0;
  for (int k = 0; k < 3; ++k) {
    const double x = v[k] + 0.0;  // makes -0.0 positive
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    h = hashedOn(h, bits);
  }
  return h;
}

}  // namespace blem_sim::geometry
