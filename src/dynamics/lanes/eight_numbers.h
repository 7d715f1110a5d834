// A number of each of eight lanes: in two of the vectors that most processors have, so that one works while the other waits, or in one
// vector of eight. Both do the same arithmetic.
#pragma once

#include <algorithm>

#include "lanes/lane_vectors.h"

namespace blem_sim::dynamics {

using Four = double __attribute__((vector_size(8 * LANES), aligned(8), may_alias));
using FourFlags = decltype(Four() > Four());
using Eight = double __attribute__((vector_size(16 * LANES), aligned(8), may_alias));
using EightFlags = decltype(Eight() > Eight());
using EightLanes = double[2 * LANES];

struct TwoFours {
  Four low, high;

  BLEM_SIM_INLINE double operator[](int lane) const { return lane < LANES ? low[lane] : high[lane - LANES]; }
};
/** Answers of comparisons, lane by lane. */
struct TwoFourFlags {
  FourFlags low, high;
};
BLEM_SIM_INLINE TwoFours operator+(const TwoFours& a, double b) { return {a.low + b, a.high + b}; }
BLEM_SIM_INLINE TwoFours operator+(const TwoFours& a, const TwoFours& b) { return {a.low + b.low, a.high + b.high}; }
BLEM_SIM_INLINE TwoFours operator-(const TwoFours& a, const TwoFours& b) { return {a.low - b.low, a.high - b.high}; }
BLEM_SIM_INLINE TwoFours operator*(const TwoFours& a, const TwoFours& b) { return {a.low * b.low, a.high * b.high}; }
BLEM_SIM_INLINE TwoFours operator*(double a, const TwoFours& b) { return {a * b.low, a * b.high}; }
BLEM_SIM_INLINE TwoFours operator/(const TwoFours& a, const TwoFours& b) { return {a.low / b.low, a.high / b.high}; }
BLEM_SIM_INLINE TwoFours operator-(const TwoFours& a) { return {-a.low, -a.high}; }
BLEM_SIM_INLINE void operator+=(TwoFours& a, const TwoFours& b) { a = a + b; }
BLEM_SIM_INLINE TwoFourFlags operator>(const TwoFours& a, const TwoFours& b) { return {a.low > b.low, a.high > b.high}; }
BLEM_SIM_INLINE TwoFourFlags operator<=(const TwoFours& a, const TwoFours& b) { return {a.low <= b.low, a.high <= b.high}; }

BLEM_SIM_INLINE TwoFours either(const TwoFourFlags& first, const TwoFours& a, const TwoFours& b) {
  return {first.low ? a.low : b.low, first.high ? a.high : b.high};
}
BLEM_SIM_INLINE Eight either(const EightFlags& first, const Eight& a, const Eight& b) { return first ? a : b; }

template <typename Numbers>
BLEM_SIM_INLINE Numbers rootOf(const Numbers& x, int lanes) {
  Numbers root;
  for (int lane = 0; lane < lanes; ++lane) root[lane] = __builtin_sqrt(x[lane]);
  return root;
}
BLEM_SIM_INLINE TwoFours squareRoot(const TwoFours& x) { return {rootOf(x.low, LANES), rootOf(x.high, LANES)}; }
BLEM_SIM_INLINE Eight squareRoot(const Eight& x) { return rootOf(x, 2 * LANES); }

/** Number `i` of each lane's numbers. */
BLEM_SIM_INLINE void gather(double* const (&from)[2 * LANES], int i, TwoFours* out) {
  *out = {Four{from[0][i], from[1][i], from[2][i], from[3][i]}, Four{from[4][i], from[5][i], from[6][i], from[7][i]}};
}
BLEM_SIM_INLINE void gather(double* const (&from)[2 * LANES], int i, Eight* out) {
  *out = Eight{from[0][i], from[1][i], from[2][i], from[3][i], from[4][i], from[5][i], from[6][i], from[7][i]};
}

/** Sums over the first lanes and over the others. */
template <typename Numbers>
BLEM_SIM_INLINE void sums(const Numbers& x, double (*out)[2]) {
  for (int half = 0, lane = 0; half < 2; ++half, lane += LANES) (*out)[half] = (x[lane] + x[lane + 1]) + (x[lane + 2] + x[lane + 3]);
}
template <typename Numbers>
BLEM_SIM_INLINE double largestOf(const Numbers& x) {
  return std::max({x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7]});
}

template <typename Numbers>
BLEM_SIM_INLINE Numbers numbers(const EightLanes& lanes) {
  return *reinterpret_cast<const Numbers*>(lanes);
}
template <>  // halves apart: compilers copy the whole by way of memory
BLEM_SIM_INLINE TwoFours numbers(const EightLanes& lanes) {
  return {*reinterpret_cast<const Four*>(lanes), *reinterpret_cast<const Four*>(lanes + LANES)};
}
BLEM_SIM_INLINE void put(const Eight& x, EightLanes* lanes) { *reinterpret_cast<Eight*>(*lanes) = x; }
BLEM_SIM_INLINE void put(const TwoFours& x, EightLanes* lanes) {
  *reinterpret_cast<Four*>(*lanes) = x.low;
  *reinterpret_cast<Four*>(*lanes + LANES) = x.high;
}

/** A vector of each lane. */
template <typename Numbers>
BLEM_SIM_INLINE TripleOf<Numbers> triples(const double (&v)[3][2 * LANES]) {
  return {numbers<Numbers>(v[0]), numbers<Numbers>(v[1]), numbers<Numbers>(v[2])};
}
}  // namespace blem_sim::dynamics
