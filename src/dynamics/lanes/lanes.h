// Terms side by side, a lane each: every lane's arithmetic is that of one term alone, so the width of the processor changes no result.
#pragma once

// Compiled for several processors, chosen when the program starts. None may fuse a product into a sum (-ffp-contract=off).
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define BLEM_SIM_LANES __attribute__((target_clones("avx2", "default")))
#define BLEM_SIM_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq")))  // for functions called where hasAvx512 says so
#else
#define BLEM_SIM_LANES
#endif

namespace blem_sim::dynamics {

#ifdef BLEM_SIM_AVX512
inline bool hasAvx512() {
  static const bool has = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
  return has;
}
#endif

constexpr int LANES = 4;
using Lanes = double[LANES];
using VectorLanes = double[3][LANES];

inline double sum(const Lanes& x) { return (x[0] + x[1]) + (x[2] + x[3]); }

}  // namespace blem_sim::dynamics
