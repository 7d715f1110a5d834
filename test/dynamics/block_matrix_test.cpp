// The matrix of blocks against a dense one.
#include "block_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace blem_sim {
namespace {

/** A matrix of random blocks and couplings, and the same dense. */
struct RandomMatrix {
  RandomMatrix(int seed, int blocks) : generator(seed) {
    for (int i = 0; i < blocks; ++i) sizes.push_back(i % 4 == 3 ? 1 + i % 10 : 6);
    sizes.back() = 0;  // something that nothing moves
    matrix.start(sizes);
    for (int a = 0; a < blocks; ++a)
      for (int b = 0; b < a; ++b)
        if (sizes[a] > 0 && uniform() > 0.4) couplings.emplace_back(a, b);
    for (const auto& [a, b] : couplings) matrix.couple(a, b);
    matrix.analyse();
    fill();
  }

  double uniform() { return static_cast<double>(generator() >> 11) * 0x1p-52 - 1; }

  void fill() {
    matrix.setZero();
    dense.setZero(matrix.size(), matrix.size());
    for (const auto& [a, b] : couplings) {
      bool transposed = false;
      BlockMatrix::Block block = matrix.coupling(a, b, &transposed);
      for (int r = 0; r < sizes[a]; ++r) {
        for (int c = 0; c < sizes[b]; ++c) {
          const double value = uniform();
          (transposed ? block(c, r) : block(r, c)) = value;
          dense(matrix.offset(a) + r, matrix.offset(b) + c) = dense(matrix.offset(b) + c, matrix.offset(a) + r) = value;
        }
      }
    }
    for (int b = 0; b < static_cast<int>(sizes.size()); ++b) {
      for (int r = 0; r < sizes[b]; ++r) {
        for (int c = 0; c <= r; ++c) {
          const double value = r == c ? 100 + uniform() : uniform();
          matrix.diagonal(b)(r, c) = value;
          dense(matrix.offset(b) + r, matrix.offset(b) + c) = dense(matrix.offset(b) + c, matrix.offset(b) + r) = value;
        }
      }
    }
  }

  void expectSolves() {
    Eigen::VectorXd right(matrix.size());
    for (double& x : right) x = uniform();
    Eigen::VectorXd x = right;
    ASSERT_TRUE(matrix.factor());
    matrix.solve(x);
    EXPECT_LT((x - dense.llt().solve(right)).lpNorm<Eigen::Infinity>(), 1e-14);
  }

  std::mt19937_64 generator;
  std::vector<int> sizes;
  std::vector<std::pair<int, int>> couplings;
  BlockMatrix matrix;
  Eigen::MatrixXd dense;
};

TEST(BlockMatrix, SolvesLikeADenseOne) {
  for (int seed = 0; seed < 20; ++seed) {
    RandomMatrix random(seed, 2 + seed);
    random.expectSolves();
    random.fill();  // the same pattern again
    random.expectSolves();
  }
}

TEST(BlockMatrix, FoldsARowAndColumnIntoAnother) {
  for (int seed = 0; seed < 20; ++seed) {
    RandomMatrix random(seed, 8);
    const int block = seed % 3, from = random.matrix.offset(block) + 4, to = random.matrix.offset(block) + 1;
    random.matrix.fold(block, 4, 1, -0.5);
    Eigen::MatrixXd& d = random.dense;
    d.row(to) += -0.5 * d.row(from);
    d.col(to) += -0.5 * d.col(from);
    d.row(from).setZero();
    d.col(from).setZero();
    d(from, from) = 1;
    random.expectSolves();
  }
}

TEST(BlockMatrix, SaysThatItIsNotPositiveDefinite) {
  RandomMatrix random(1, 5);
  random.matrix.diagonal(2)(3, 3) = -1;
  EXPECT_FALSE(random.matrix.factor());
}

}  // namespace
}  // namespace blem_sim
