// Vectors of doubles as wide as the instruction set this file is compiled for. Element by element IEEE arithmetic without contraction: the
// width does not change a bit of any result. Included by the kernels only; nothing here has a name that another object file could share.
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <cstdint>

#include "kernels/records.h"

namespace blem_sim::contact::kernels {
namespace {

#if defined(__AVX512F__)
constexpr int LANES = 8;
#elif defined(__AVX2__)
constexpr int LANES = 4;
#else
constexpr int LANES = 2;
#endif
constexpr int FLOAT_LANES = LANES < 4 ? 2 * LANES : 8;  // a leaf has few features of a kind

typedef double Doubles __attribute__((vector_size(8 * LANES)));
using Mask = decltype(Doubles{} > Doubles{});
typedef float Floats __attribute__((vector_size(4 * FLOAT_LANES)));
using FloatMask = decltype(Floats{} > Floats{});

/** Coordinates of as many vectors as there are lanes. */
template <typename Lanes>
struct VectorsOf {
  Lanes x, y, z;
};
using Vectors = VectorsOf<Doubles>;
using FloatVectors = VectorsOf<Floats>;

inline Doubles all(double value) { return value - Doubles{}; }
inline Floats allFloats(float value) { return value - Floats{}; }

inline unsigned bitsOf(Mask mask) {
#if defined(__AVX512F__)
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
#elif defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#elif defined(__x86_64__)
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(mask)));
#else
  unsigned bits = 0;
  for (int i = 0; i < LANES; ++i) bits |= static_cast<unsigned>(mask[i] != 0) << i;
  return bits;
#endif
}

inline unsigned bitsOf(FloatMask mask) {
#if defined(__AVX512F__)
  return _mm256_movepi32_mask(reinterpret_cast<__m256i>(mask));
#elif defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#elif defined(__x86_64__)
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  unsigned bits = 0;
  for (int i = 0; i < FLOAT_LANES; ++i) bits |= static_cast<unsigned>(mask[i] != 0) << i;
  return bits;
#endif
}

inline Doubles squareRoot(Doubles v) {
#if defined(__AVX512F__)
  return reinterpret_cast<Doubles>(_mm512_sqrt_pd(reinterpret_cast<__m512d>(v)));
#elif defined(__AVX2__)
  return reinterpret_cast<Doubles>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(v)));
#elif defined(__x86_64__)
  return reinterpret_cast<Doubles>(_mm_sqrt_pd(reinterpret_cast<__m128d>(v)));
#else
  for (int i = 0; i < LANES; ++i) v[i] = __builtin_sqrt(v[i]);
  return v;
#endif
}

inline Floats squareRoot(Floats v) {
#if defined(__AVX2__)
  return reinterpret_cast<Floats>(_mm256_sqrt_ps(reinterpret_cast<__m256>(v)));
#elif defined(__x86_64__)
  return reinterpret_cast<Floats>(_mm_sqrt_ps(reinterpret_cast<__m128>(v)));
#else
  for (int i = 0; i < FLOAT_LANES; ++i) v[i] = __builtin_sqrtf(v[i]);
  return v;
#endif
}

inline Doubles minimum(Doubles a, Doubles b) { return a < b ? a : b; }
inline Doubles maximum(Doubles a, Doubles b) { return a > b ? a : b; }
inline Doubles absolute(Doubles a) { return reinterpret_cast<Doubles>(reinterpret_cast<Mask>(a) & 0x7FFFFFFFFFFFFFFF); }
inline Doubles clampedToUnit(Doubles a) { return minimum(maximum(a, Doubles{}), all(1)); }
inline Floats maximum(Floats a, Floats b) { return a > b ? a : b; }
inline Floats minimum(Floats a, Floats b) { return a < b ? a : b; }
inline Floats absolute(Floats a) { return a < 0 ? -a : a; }
inline Floats clampedToUnit(Floats a) { return minimum(maximum(a, Floats{}), allFloats(1)); }

template <typename Lanes>
inline Lanes dot(const VectorsOf<Lanes>& a, const VectorsOf<Lanes>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename Lanes>
inline VectorsOf<Lanes> cross(const VectorsOf<Lanes>& a, const VectorsOf<Lanes>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename Lanes>
inline VectorsOf<Lanes> operator+(const VectorsOf<Lanes>& a, const VectorsOf<Lanes>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename Lanes>
inline VectorsOf<Lanes> operator-(const VectorsOf<Lanes>& a, const VectorsOf<Lanes>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename Lanes>
inline VectorsOf<Lanes> operator*(Lanes s, const VectorsOf<Lanes>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

/** Four vectors from as many Vec4 as there are lanes. */
struct Rows {
  Vectors v;
  Doubles w;
};

inline Rows everywhere(const Vec4& one) { return {{all(one.x), all(one.y), all(one.z)}, all(one.w)}; }

inline Rows gathered(const Vec4* const* from) {
  Rows rows;
#if defined(__AVX512F__)
  // Lanes 0 to 3 with 4 to 7 behind them, then turned four by four.
  const auto pair = [from](int i) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(&from[i]->x)), _mm256_load_pd(&from[i + 4]->x), 1);
  };
  const __m512d a = pair(0), b = pair(1), c = pair(2), d = pair(3);
  const __m512d ab_xz = _mm512_unpacklo_pd(a, b), ab_yw = _mm512_unpackhi_pd(a, b);
  const __m512d cd_xz = _mm512_unpacklo_pd(c, d), cd_yw = _mm512_unpackhi_pd(c, d);
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  rows.v.x = reinterpret_cast<Doubles>(_mm512_permutex2var_pd(ab_xz, low, cd_xz));
  rows.v.y = reinterpret_cast<Doubles>(_mm512_permutex2var_pd(ab_yw, low, cd_yw));
  rows.v.z = reinterpret_cast<Doubles>(_mm512_permutex2var_pd(ab_xz, high, cd_xz));
  rows.w = reinterpret_cast<Doubles>(_mm512_permutex2var_pd(ab_yw, high, cd_yw));
#elif defined(__AVX2__)
  const __m256d a = _mm256_load_pd(&from[0]->x), b = _mm256_load_pd(&from[1]->x), c = _mm256_load_pd(&from[2]->x),
                d = _mm256_load_pd(&from[3]->x);
  const __m256d ab_xz = _mm256_unpacklo_pd(a, b), ab_yw = _mm256_unpackhi_pd(a, b);
  const __m256d cd_xz = _mm256_unpacklo_pd(c, d), cd_yw = _mm256_unpackhi_pd(c, d);
  rows.v.x = reinterpret_cast<Doubles>(_mm256_permute2f128_pd(ab_xz, cd_xz, 0x20));
  rows.v.y = reinterpret_cast<Doubles>(_mm256_permute2f128_pd(ab_yw, cd_yw, 0x20));
  rows.v.z = reinterpret_cast<Doubles>(_mm256_permute2f128_pd(ab_xz, cd_xz, 0x31));
  rows.w = reinterpret_cast<Doubles>(_mm256_permute2f128_pd(ab_yw, cd_yw, 0x31));
#else
  for (int i = 0; i < LANES; ++i) {
    rows.v.x[i] = from[i]->x;
    rows.v.y[i] = from[i]->y;
    rows.v.z[i] = from[i]->z;
    rows.w[i] = from[i]->w;
  }
#endif
  return rows;
}

/** Turns eight columns of lanes into as many rows of eight numbers as there are lanes, written one after the other to row(lane). */
template <typename Row>
inline void transposed(const Doubles (&columns)[8], Row&& row) {
#if defined(__AVX512F__)
  const auto column = [&columns](int i) { return reinterpret_cast<__m512d>(columns[i]); };
  // Pairs of columns, then of pairs, then of those: in each 128 bits, two lanes further on, four.
  __m512d low[4], high[4];
  for (int i = 0; i < 4; ++i) {
    low[i] = _mm512_unpacklo_pd(column(2 * i), column(2 * i + 1));
    high[i] = _mm512_unpackhi_pd(column(2 * i), column(2 * i + 1));
  }
  __m512d turned[8];
  const auto turn = [&turned](const __m512d(&pairs)[4], int first) {
    const __m512d a = _mm512_shuffle_f64x2(pairs[0], pairs[1], 0x88), b = _mm512_shuffle_f64x2(pairs[2], pairs[3], 0x88);
    const __m512d c = _mm512_shuffle_f64x2(pairs[0], pairs[1], 0xDD), d = _mm512_shuffle_f64x2(pairs[2], pairs[3], 0xDD);
    turned[first] = _mm512_shuffle_f64x2(a, b, 0x88);
    turned[first + 4] = _mm512_shuffle_f64x2(a, b, 0xDD);
    turned[first + 2] = _mm512_shuffle_f64x2(c, d, 0x88);
    turned[first + 6] = _mm512_shuffle_f64x2(c, d, 0xDD);
  };
  turn(low, 0);
  turn(high, 1);
  for (int lane = 0; lane < LANES; ++lane) _mm512_storeu_pd(row(lane), turned[lane]);
#else
  for (int lane = 0; lane < LANES; ++lane) {
    double* const to = row(lane);
    for (int i = 0; i < 8; ++i) to[i] = columns[i][lane];
  }
#endif
}

}  // namespace
}  // namespace blem_sim::contact::kernels
