// Blocks of 6 x 6, of free bodies that touch each other: by far the most frequent ones of a heap. Column-major; blocks of a column of the
// matrix lie one behind the other.
#pragma once

#include <cstddef>

namespace blem_sim::dynamics {

constexpr int FREE = 6;                          ///< dofs of a free body
constexpr std::size_t FREE_BLOCK = FREE * FREE;  ///< numbers of a block

/** Cholesky factor in the lower triangle. @return false if the block is not positive definite */
bool factorFree(double* block);
/** Blocks below the diagonal times the inverse of the diagonal's transposed factor l. */
void divideFree(const double* l, int count, double* blocks);
/** values[at[i]...] -= a_i b' */
void subtractFree(const double* b, const double* a, int count, const std::size_t* at, double* values);

/** A factored column of a matrix: its diagonal block l, and the blocks below it, which begin at the given rows. */
struct FreeColumn {
  const double* l;
  int count;  ///< of blocks below the diagonal; they lie behind l
  const int* rows;

  const double* blocks() const { return l + FREE_BLOCK; }
};

/** own := l^-1 own; then x[row_i...] -= block_i own */
void forwardFree(const FreeColumn& column, double* own, double* x);
/** own -= sum of block_i' x[row_i...]; then own := l'^-1 own */
void backwardFree(const FreeColumn& column, double* own, const double* x);

}  // namespace blem_sim::dynamics
