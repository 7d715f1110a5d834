// Vectors of one lane, for the kernels of contacts: small enough that compilers keep them in registers, and loops over lanes become vector
// code.
#pragma once

#include "lanes/lanes.h"

#if defined(__GNUC__)
#define BLEM_SIM_INLINE inline __attribute__((always_inline))
#else
#define BLEM_SIM_INLINE inline
#endif

#pragma GCC diagnostic ignored "-Wpsabi"  // of functions that are always inlined

namespace blem_sim::dynamics {

/** A vector of one lane, or of several. */
template <typename Number>
struct TripleOf {
  Number x, y, z;
};
using Triple = TripleOf<double>;
template <int WIDTH>
BLEM_SIM_INLINE Triple at(const double (&v)[3][WIDTH], int lane) {
  return {v[0][lane], v[1][lane], v[2][lane]};
}
BLEM_SIM_INLINE void put(const Triple& v, int lane, VectorLanes* out) {
  (*out)[0][lane] = v.x;
  (*out)[1][lane] = v.y;
  (*out)[2][lane] = v.z;
}
template <typename Number>
BLEM_SIM_INLINE TripleOf<Number> operator+(const TripleOf<Number>& a, const TripleOf<Number>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename Number>
BLEM_SIM_INLINE TripleOf<Number> operator-(const TripleOf<Number>& a, const TripleOf<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename Number>
BLEM_SIM_INLINE TripleOf<Number> operator-(const TripleOf<Number>& a) {
  return {-a.x, -a.y, -a.z};
}
template <typename Number>
BLEM_SIM_INLINE TripleOf<Number> operator*(const Number& s, const TripleOf<Number>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <typename Number>
BLEM_SIM_INLINE Number dot(const TripleOf<Number>& a, const TripleOf<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename Number>
BLEM_SIM_INLINE TripleOf<Number> cross(const TripleOf<Number>& a, const TripleOf<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
BLEM_SIM_INLINE Triple either(bool first, const Triple& a, const Triple& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

}  // namespace blem_sim::dynamics
