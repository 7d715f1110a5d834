// The matrix of blocks against a dense one.
#include "trees/block_matrix.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "trees/elimination_order.h"

namespace blem_sim::dynamics {
namespace {

using Couplings = std::vector<std::pair<int, int>>;

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
    for (int i = 0; i < right.size(); ++i) right[i] = uniform();
    Eigen::VectorXd x = right;
    ASSERT_TRUE(matrix.factor(&team));
    matrix.solve(x);
    EXPECT_LT((x - dense.llt().solve(right)).lpNorm<Eigen::Infinity>(), 1e-14);
  }

  std::mt19937_64 generator;
  std::vector<int> sizes;
  Couplings couplings;
  BlockMatrix matrix;
  Eigen::MatrixXd dense;
  Team team;
};

TEST(BlockMatrix, SolvesLikeADenseOne) {
  for (int seed = 0; seed < 20; ++seed) {
    RandomMatrix random(seed, 2 + seed);
    random.expectSolves();
    random.fill();  // the same pattern again
    random.expectSolves();
  }
}

/** The order by its definition: degrees counted anew after each elimination, of equal ones the last block. */
std::vector<int> leastDegreeOrder(const std::vector<int>& sizes, const Couplings& couplings, std::vector<std::set<int>>* neighbours) {
  std::vector<std::set<int>> coupled(sizes.size());
  for (const auto& [a, b] : couplings) {
    coupled[a].insert(b);
    coupled[b].insert(a);
  }
  const auto degree = [&](int block) {
    int degree = 0;
    for (const int other : coupled[block]) degree += sizes[other];
    return degree;
  };
  std::set<int> left;
  for (int block = 0; block < static_cast<int>(sizes.size()); ++block) left.insert(block);
  std::vector<int> order;
  while (!left.empty()) {
    const int next = *std::min_element(left.rbegin(), left.rend(), [&](int p, int q) { return degree(p) < degree(q); });
    left.erase(next);
    order.push_back(next);
    neighbours->push_back(coupled[next]);
    for (const int a : coupled[next]) {
      coupled[a].erase(next);
      for (const int b : coupled[next])
        if (a != b) coupled[a].insert(b);
    }
  }
  return order;
}

TEST(EliminationOrder, TakesTheLeastDegreeAndOfEqualOnesTheLastBlock) {
  for (int seed = 0; seed < 40; ++seed) {
    std::mt19937_64 generator(seed);
    const int blocks = 2 + 4 * seed;  // more than a word has bits, too
    std::vector<int> sizes;
    for (int i = 0; i < blocks; ++i) sizes.push_back(seed % 2 ? 6 : static_cast<int>(generator() % 10));
    Couplings couplings;
    for (int i = 0; i < 3 * blocks; ++i) {
      const int a = static_cast<int>(generator() % blocks), b = static_cast<int>(generator() % blocks);
      if (a != b) couplings.emplace_back(a, b);
    }
    std::vector<std::set<int>> expected_neighbours;
    const std::vector<int> expected = leastDegreeOrder(sizes, couplings, &expected_neighbours);
    EliminationOrder order;
    order.start(sizes);
    for (const auto& [a, b] : couplings) order.couple(a, b);
    std::vector<int> neighbours;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_FALSE(order.finished());
      ASSERT_EQ(order.next(&neighbours), expected[i]) << seed;
      ASSERT_EQ(neighbours, std::vector<int>(expected_neighbours[i].begin(), expected_neighbours[i].end())) << seed;
    }
    EXPECT_TRUE(order.finished());
  }
}

/** Free bodies of a heap, each touching those beside, below and above it. */
Couplings heapOf(int blocks) {
  constexpr int COLUMNS = 10;
  Couplings couplings;
  for (int i = 0; i < blocks; ++i) {
    if (i % COLUMNS > 0) couplings.emplace_back(i, i - 1);
    if (i / COLUMNS % COLUMNS > 0) couplings.emplace_back(i, i - COLUMNS);
    if (i >= COLUMNS * COLUMNS) couplings.emplace_back(i, i - COLUMNS * COLUMNS);
  }
  return couplings;
}

/** Fills the matrix: `diagonal` times the identity, couplings below 1. @return matrix times x */
Eigen::VectorXd fillHeap(const Couplings& couplings, int blocks, double diagonal, const Eigen::VectorXd& x, BlockMatrix* matrix) {
  matrix->setZero();
  Eigen::VectorXd product = diagonal * x;
  for (int b = 0; b < blocks; ++b) matrix->diagonal(b).diagonal().setConstant(diagonal);
  for (const auto& [a, b] : couplings) {
    bool transposed = false;
    BlockMatrix::Block block = matrix->coupling(a, b, &transposed);
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 6; ++c) {
        const double value = std::sin(a + 2 * b + 3 * r + 5 * c);
        (transposed ? block(c, r) : block(r, c)) = value;
        product[matrix->offset(a) + r] += value * x[matrix->offset(b) + c];
        product[matrix->offset(b) + c] += value * x[matrix->offset(a) + r];
      }
    }
  }
  return product;
}

TEST(BlockMatrix, SolvesAHeapOfAThousandBodies) {
  constexpr int BLOCKS = 1000;
  const Couplings couplings = heapOf(BLOCKS);
  BlockMatrix matrix;
  Team team;
  for (int round = 0; round < 2; ++round) {  // the same pattern again
    matrix.start(std::vector<int>(BLOCKS, 6));
    for (const auto& [a, b] : couplings) matrix.couple(a, b);
    matrix.analyse();
    const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(matrix.size(), -1, 1);
    Eigen::VectorXd x = fillHeap(couplings, BLOCKS, 100, expected, &matrix);
    ASSERT_TRUE(matrix.factor(&team));
    matrix.solve(x);
    EXPECT_LT((x - expected).lpNorm<Eigen::Infinity>(), 1e-13);
  }
}

TEST(BlockMatrix, HasTheSameFactorForAnyNumberOfThreads) {
  constexpr int BLOCKS = 300;
  const Couplings couplings = heapOf(BLOCKS);
  Eigen::VectorXd solved[2];
  for (const int helpers : {0, 1}) {
    BlockMatrix matrix;
    Team team;
    matrix.start(std::vector<int>(BLOCKS, 6));
    for (const auto& [a, b] : couplings) matrix.couple(a, b);
    matrix.analyse();
    solved[helpers] = fillHeap(couplings, BLOCKS, 100, Eigen::VectorXd::LinSpaced(matrix.size(), -1, 1), &matrix);
    tbb::task_arena(2).execute([&] { team.with(helpers, [&] { ASSERT_TRUE(matrix.factor(&team)); }); });
    matrix.solve(solved[helpers]);
  }
  EXPECT_EQ(solved[0], solved[1]);
}

TEST(BlockMatrix, AnalysesAnotherPatternOfAsManyBlocks) {
  BlockMatrix matrix;
  Team team;
  for (const Couplings& couplings : {Couplings{{1, 0}}, Couplings{{2, 0}}, Couplings{{2, 1}, {1, 0}}, Couplings{}}) {
    matrix.start({6, 6, 6});
    for (const auto& [a, b] : couplings) matrix.couple(a, b);
    matrix.analyse();
    const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(matrix.size(), -1, 1);
    Eigen::VectorXd x = fillHeap(couplings, 3, 100, expected, &matrix);
    ASSERT_TRUE(matrix.factor(&team));
    matrix.solve(x);
    EXPECT_LT((x - expected).lpNorm<Eigen::Infinity>(), 1e-14);
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
  EXPECT_FALSE(random.matrix.factor(&random.team));
}

}  // namespace
}  // namespace blem_sim::dynamics
