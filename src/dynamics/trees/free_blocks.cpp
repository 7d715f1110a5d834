#include "trees/free_blocks.h"

#include <cmath>

#include "lanes/lanes.h"

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

BLEM_SIM_LANES void subtractFree(const double* b, const double* a, int count, const std::size_t* at, double* values) {
  for (int n = 0; n < count; ++n, a += FREE_BLOCK) {
    double* c = values + at[n];
    for (int j = 0; j < FREE; ++j, c += FREE) {
      FourRows upper = fourRows(a) * b[j];
      Two lower = two(a) * b[j];
      for (int k = 1; k < FREE; ++k) {
        upper += fourRows(a + FREE * k) * b[FREE * k + j];
        lower += two(a + FREE * k) * b[FREE * k + j];
      }
      fourRows(c) -= upper;
      two(c) -= lower;
    }
  }
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
