// Whether a vertex is over a face, or so little beside it that its contact fades: lanes of floats or doubles. Included by the kernels only.
#pragma once

#include "features/tolerances.h"
#include "kernels/simd.h"

namespace blem_sim::contact::kernels {
namespace {

/** Bits 0 to 2: the sides that are open to vertices at that height, wherever it is within the margin [m]. */
template <typename Bits, typename Lanes, typename Number>
inline Bits openSides(Bits open, Lanes height, Number margin) {
  const Bits below = open >> 3;
  return height > margin ? open : height < -margin ? below : open | below;
}

/** @param inside [m] of the three sides @param open as openSides @param most [m] of depth to lose @param beside [m] that counts as over */
template <typename Bits, typename Lanes, typename Number>
inline auto isOverOrFades(const Lanes (&inside)[3], Bits open, Lanes most, Number beside) {
  const Lanes fades = most / static_cast<Number>(FADE_SLOPE);
  auto is = inside[0] >= inside[0];
  for (int k = 0; k < 3; ++k) is &= inside[k] >= -((open >> k & 1) != 0 ? fades + beside : beside - Lanes{});
  return is;
}

}  // namespace
}  // namespace blem_sim::contact::kernels
