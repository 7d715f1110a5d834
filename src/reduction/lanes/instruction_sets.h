// Loops over plain arrays, compiled for several processors: the widest that the machine has is taken when the program starts. None may fuse
// a product into a sum (-ffp-contract=off), and no sum is reordered: all give the same bits.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define BLEM_SIM_LANES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define BLEM_SIM_LANES
#endif
#if defined(__GNUC__)
#define BLEM_SIM_INLINE inline __attribute__((always_inline))
#else
#define BLEM_SIM_INLINE inline
#endif
