// A symmetric positive definite matrix of blocks, few of which are coupled, and its Cholesky factor.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include "trees/elimination_order.h"
#include "trees/team.h"

namespace blem_sim::dynamics {

/**
 * Use: start, couple, analyse; then setZero, fill, factor, solve as often as wished. Blocks are eliminated in an order of least degree
 * (EliminationOrder), which changes only the cost; a pattern told as the last one was needs no analysis. A pattern no larger than an
 * earlier one allocates nothing.
 */
class BlockMatrix {
 public:
  using Block = Eigen::Map<Eigen::MatrixXd>;

  /** Begins a pattern of blocks, none of them coupled. */
  void start(const std::vector<int>& sizes);
  /** Notes that two different blocks are coupled. */
  void couple(int a, int b);
  /** Chooses the order and makes room for the blocks that elimination fills in. */
  void analyse();

  void setZero();
  /** A block on the diagonal, of which only the lower triangle counts. */
  Block diagonal(int block);
  /** The block of rows `a` and columns `b`, which are coupled, or, if `transposed` says so, of rows b and columns a. */
  Block coupling(int a, int b, bool* transposed);
  /** Adds `factor` times row and column `from` of a block to `to`, everywhere, and leaves an identity there. */
  void fold(int block, int from, int to, double factor);
  /** Row of the whole vector where a block begins. */
  int offset(int block) const { return offsets_[block]; }
  int size() const { return size_; }

  /** @param team its threads share the columns. @return false if the matrix is not positive definite */
  bool factor(Team* team);
  /** Solves in place. Precondition: factor */
  void solve(Eigen::Ref<Eigen::VectorXd> x) const;

 private:
  struct Column {
    int block = 0, size = 0;   // eliminated here
    int offset = 0;            // of the block in a vector
    std::size_t diagonal = 0;  // in values_, followed by those of its entries
    int first = 0, end = 0;    // of its entries below the diagonal
    bool free = false;         // it and all its entries are of free bodies
  };
  struct Entry {
    int column = 0;         // in which its row's block is eliminated
    std::size_t value = 0;  // in values_
  };
  void eliminateAll();
  void sortEntries();
  void place();
  Block entryBlock(const Column& column, const Entry& entry);
  Eigen::Map<const Eigen::MatrixXd> entryBlock(const Column& column, const Entry& entry) const;
  Entry* find(int row, int column);
  bool factorColumn(const Column& column);
  void findTargets(const Column& column, int e, std::size_t* targets) const;
  void subtractOuter(const Column& column, int e, std::size_t* targets);
  bool eliminate(int at, bool shared, std::size_t* targets);
  bool eliminateByTurns(std::size_t* targets, std::atomic<int>* next);
  void forward(const Column& column, Eigen::Ref<Eigen::VectorXd> x) const;
  void backward(const Column& column, Eigen::Ref<Eigen::VectorXd> x) const;

  int size_ = 0;
  std::vector<int> sizes_, offsets_;
  std::vector<std::pair<int, int>> couplings_;  // as they were told
  // Pattern that the columns at hand were made for.
  std::vector<int> analysed_sizes_;
  std::vector<std::pair<int, int>> analysed_couplings_;
  EliminationOrder order_;
  std::vector<int> neighbours_;                             // of the block that is eliminated
  std::vector<int> row_start_, row_columns_, row_entries_;  // row by row: the columns with an entry there, ascending, and the entries
  std::vector<int> filled_;                                 // of columns or rows, while entries are sorted
  std::vector<int> position_;                               // per block: its column
  std::vector<Column> columns_;
  std::vector<Entry> entries_;
  std::vector<int> rows_;  // per entry: first row of its row's block in a vector
  std::vector<double> values_;
  std::size_t most_entries_ = 0;               // of a column
  std::vector<std::size_t> targets_;           // in values_: blocks that an entry's outer products are subtracted from; for each chunk
  std::unique_ptr<std::atomic<char>[]> done_;  // per column, while threads share them: whether it is factored
  std::size_t done_room_ = 0;
};

}  // namespace blem_sim::dynamics
