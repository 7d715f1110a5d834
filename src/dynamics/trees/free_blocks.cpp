#include "trees/free_blocks.h"

#include <cmath>

#include "lanes/lanes.h"

#ifdef BLEM_SIM_AVX512
#include <immintrin.h>
#endif

namespace blem_sim::dynamics {
namespace {

// A column of a block: four rows and two. Compilers lower them to the processor's own vectors.
using FourRows = double __attribute__((vector_size(32), aligned(8), may_alias));
using Two = double __attribute__((vector_size(16), aligned(8), may_alias));

inline FourRows& fourRows(double* column) { return *reinterpret_cast<FourRows*>(column); }
inline const FourRows& fourRows(const double* column) { return *reinterpret_cast<const FourRows*>(column); }
inline Two& two(double* column) { return *reinterpret_cast<Two*>(column + 4); }
inline const Two& two(const double* column) { return *reinterpret_cast<const Two*>(column + 4); }

/** Sum of products in two interleaved halves, as they come from a processor's pairs. */
template <int N>
inline double blockDot(const double* p, const double* q) {
  if (N == 1) return p[0] * q[0];
  if (N < 4) {
    const double two = p[0] * q[0] + p[1] * q[1];
    return N == 3 ? two + p[2] * q[2] : two;
  }
  double even = p[0] * q[0] + p[2] * q[2], odd = p[1] * q[1] + p[3] * q[3];
  if (N == 6) {
    even += p[4] * q[4];
    odd += p[5] * q[5];
  }
  return N == 5 ? (even + odd) + p[4] * q[4] : even + odd;
}

}  // namespace

bool factorFree(double* a) {
  for (int k = 0; k < FREE; ++k) {
    double* column = a + FREE * k;
    if (!(column[k] > 0)) return false;
    column[k] = std::sqrt(column[k]);
    const double inverse = 1 / column[k];
    for (int i = k + 1; i < FREE; ++i) column[i] *= inverse;
    for (int j = k + 1; j < FREE; ++j)
      for (int i = j; i < FREE; ++i) a[FREE * j + i] -= column[i] * column[j];
  }
  return true;
}

BLEM_SIM_LANES void divideFree(const double* l, int count, double* blocks) {
  for (int n = 0; n < count; ++n, blocks += FREE_BLOCK) {
    for (int k = 0; k < FREE; ++k) {
      double* own = blocks + FREE * k;
      const FourRows upper = fourRows(own) / l[FREE * k + k];
      const Two lower = two(own) / l[FREE * k + k];
      fourRows(own) = upper;
      two(own) = lower;
      for (int j = k + 1; j < FREE; ++j) {
        fourRows(blocks + FREE * j) -= l[FREE * k + j] * upper;
        two(blocks + FREE * j) -= l[FREE * k + j] * lower;
      }
    }
  }
}

namespace {

// Two columns at a time, whose two lower rows share a vector.
BLEM_SIM_LANES void subtractNarrow(const double* b, const double* a, int count, const std::size_t* at, double* values) {
  FourRows factors[FREE][FREE / 2];  // of the lower rows
  for (int k = 0; k < FREE; ++k)
    for (int j = 0; j < FREE; j += 2)
      factors[k][j / 2] = FourRows{b[FREE * k + j], b[FREE * k + j], b[FREE * k + j + 1], b[FREE * k + j + 1]};
  for (int n = 0; n < count; ++n, a += FREE_BLOCK) {
    double* c = values + at[n];
    FourRows twice[FREE];
    for (int k = 0; k < FREE; ++k) twice[k] = FourRows{a[FREE * k + 4], a[FREE * k + 5], a[FREE * k + 4], a[FREE * k + 5]};
    for (int j = 0; j < FREE; j += 2, c += 2 * FREE) {
      FourRows left = fourRows(a) * b[j], right = fourRows(a) * b[j + 1], lower = twice[0] * factors[0][j / 2];
      for (int k = 1; k < FREE; ++k) {
        left += fourRows(a + FREE * k) * b[FREE * k + j];
        right += fourRows(a + FREE * k) * b[FREE * k + j + 1];
        lower += twice[k] * factors[k][j / 2];
      }
      fourRows(c) -= left;
      fourRows(c + FREE) -= right;
      two(c) -= Two{lower[0], lower[1]};
      two(c + FREE) -= Two{lower[2], lower[3]};
    }
  }
}

#ifdef BLEM_SIM_AVX512

/** The same sums, a column of six rows in a vector of eight. */
BLEM_SIM_AVX512 void subtractWide(const double* b, const double* a, int count, const std::size_t* at, double* values) {
  constexpr __mmask8 ALL = 0xff;
  const __m512i last_six = _mm512_set_epi64(7, 7, 7, 6, 5, 4, 3, 2);
  for (int n = 0; n < count; ++n, a += FREE_BLOCK) {
    __m512d columns[FREE];  // the last two numbers of each are the next column's, and nobody's
    for (int k = 0; k + 1 < FREE; ++k) columns[k] = _mm512_loadu_pd(a + FREE * k);
    columns[FREE - 1] = _mm512_maskz_permutexvar_pd(ALL, last_six, _mm512_loadu_pd(a + FREE_BLOCK - 8));
    double* c = values + at[n];
    for (int j = 0; j < FREE; ++j, c += FREE) {
      __m512d sum = _mm512_mul_pd(columns[0], _mm512_set1_pd(b[j]));
      for (int k = 1; k < FREE; ++k) sum = _mm512_add_pd(sum, _mm512_mul_pd(columns[k], _mm512_set1_pd(b[FREE * k + j])));
      const __m256d upper = _mm512_maskz_extractf64x4_pd(ALL, sum, 0);
      const __m128d lower = _mm512_maskz_extractf64x2_pd(ALL, sum, 2);
      _mm256_storeu_pd(c, _mm256_sub_pd(_mm256_loadu_pd(c), upper));
      _mm_storeu_pd(c + 4, _mm_sub_pd(_mm_loadu_pd(c + 4), lower));
    }
  }
}

#endif

}  // namespace

void subtractFree(const double* b, const double* a, int count, const std::size_t* at, double* values) {
#ifdef BLEM_SIM_AVX512
  if (hasAvx512()) return subtractWide(b, a, count, at, values);
#endif
  subtractNarrow(b, a, count, at, values);
}

BLEM_SIM_LANES void forwardFree(const FreeColumn& column, double* own, double* x) {
  const double *l = column.l, *blocks = column.blocks();
  const int* rows = column.rows;
  for (int k = 0; k < FREE; ++k) {
    own[k] /= l[FREE * k + k];
    for (int i = k + 1; i < FREE; ++i) own[i] -= own[k] * l[FREE * k + i];
  }
  for (int n = 0; n < column.count; ++n, blocks += FREE_BLOCK) {
    FourRows upper = fourRows(blocks) * own[0];
    Two lower = two(blocks) * own[0];
    for (int k = 1; k < FREE; ++k) {
      upper += fourRows(blocks + FREE * k) * own[k];
      lower += two(blocks + FREE * k) * own[k];
    }
    fourRows(x + rows[n]) -= upper;
    two(x + rows[n]) -= lower;
  }
}

void backwardFree(const FreeColumn& column, double* own, const double* x) {
  const double *l = column.l, *blocks = column.blocks();
  const int* rows = column.rows;
  for (int n = 0; n < column.count; ++n, blocks += FREE_BLOCK)
    for (int i = 0; i < FREE; ++i) own[i] -= blockDot<FREE>(blocks + FREE * i, x + rows[n]);
  own[5] /= l[35];
  own[4] = (own[4] - blockDot<1>(l + 29, own + 5)) / l[28];
  own[3] = (own[3] - blockDot<2>(l + 22, own + 4)) / l[21];
  own[2] = (own[2] - blockDot<3>(l + 15, own + 3)) / l[14];
  own[1] = (own[1] - blockDot<4>(l + 8, own + 2)) / l[7];
  own[0] = (own[0] - blockDot<5>(l + 1, own + 1)) / l[0];
}

}  // namespace blem_sim::dynamics
