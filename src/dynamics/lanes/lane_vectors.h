// Vectors of one lane, for the kernels of contacts: small enough that compilers keep them in registers, and loops over lanes become vector
// code.
#pragma once

#include "lanes/lanes.h"

#if defined(__GNUC__)
#define BLEM_SIM_INLINE inline __attribute__((always_inline))
#else
#define BLEM_SIM_INLINE inline
#endif

namespace blem_sim::dynamics {

struct Triple {
  double x, y, z;
};
template <int WIDTH>
BLEM_SIM_INLINE Triple at(const double (&v)[3][WIDTH], int lane) {
  return {v[0][lane], v[1][lane], v[2][lane]};
}
BLEM_SIM_INLINE void put(const Triple& v, int lane, VectorLanes* out) {
  (*out)[0][lane] = v.x;
  (*out)[1][lane] = v.y;
  (*out)[2][lane] = v.z;
}
BLEM_SIM_INLINE Triple operator+(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
BLEM_SIM_INLINE Triple operator-(const Triple& a, const Triple& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
BLEM_SIM_INLINE Triple operator*(double s, const Triple& a) { return {s * a.x, s * a.y, s * a.z}; }
BLEM_SIM_INLINE double dot(const Triple& a, const Triple& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
BLEM_SIM_INLINE Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
BLEM_SIM_INLINE Triple either(bool first, const Triple& a, const Triple& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

}  // namespace blem_sim::dynamics
