// Bounds on the difference of two contacts' wrenches.
#pragma once

#include <cmath>

namespace blem_sim::reduction {

// A largest component changes by no more than these times the way to another place [radii], and to another normal: both stem from
// |g.n + mu |g - (g.n) n|| <= sqrt(1 + mu^2) |g|, with mu 0.5, |g| <= sqrt(2), and angles up to pi / 2 times their chords.
constexpr float PER_PLACE = 1.12f, PER_NORMAL = 2.49f;
constexpr float ROUNDING = 1e-3f;  // in unit forces: components are floats

inline float distance(const float (&a)[3], const float (&b)[3]) {
  const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace blem_sim::reduction
