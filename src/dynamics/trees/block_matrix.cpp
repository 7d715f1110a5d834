#include "trees/block_matrix.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "trees/free_blocks.h"
#include "trees/wait.h"

namespace blem_sim::dynamics {
namespace {

using FreeBlock = Eigen::Matrix<double, FREE, FREE>;
using FreeMap = Eigen::Map<FreeBlock>;

constexpr int MANY_ENTRIES = 200;  // of a matrix: the fewest that are worth another thread
constexpr int MOST_CHUNKS = 8;     // threads that take part

/** Rows of a block below the diagonal times the inverse of the diagonal's transposed factor. */
template <typename Rows, typename Factor>
void divide(Rows&& rows, const Factor& l) {
  for (int k = 0; k < l.cols(); ++k) {
    rows.col(k) /= l(k, k);
    for (int j = k + 1; j < l.cols(); ++j) rows.col(j) -= l(j, k) * rows.col(k);
  }
}

}  // namespace

void BlockMatrix::start(const std::vector<int>& sizes) {
  sizes_ = sizes;
  offsets_.clear();
  size_ = 0;
  for (const int size : sizes_) {
    offsets_.push_back(size_);
    size_ += size;
  }
  couplings_.clear();
}

void BlockMatrix::couple(int a, int b) { couplings_.emplace_back(a, b); }

void BlockMatrix::analyse() {
  if (sizes_ == analysed_sizes_ && couplings_ == analysed_couplings_) return;
  analysed_sizes_ = sizes_;
  analysed_couplings_ = couplings_;
  eliminateAll();
  sortEntries();
  place();
}

void BlockMatrix::eliminateAll() {
  order_.start(sizes_);
  for (const auto& [a, b] : couplings_) order_.couple(a, b);
  position_.resize(sizes_.size());
  columns_.clear();
  entries_.clear();
  while (!order_.finished()) {
    Column column;
    column.block = order_.next(&neighbours_);
    column.size = sizes_[column.block];
    column.offset = offsets_[column.block];
    column.first = static_cast<int>(entries_.size());
    position_[column.block] = static_cast<int>(columns_.size());
    for (const int other : neighbours_) entries_.push_back({other, 0});
    column.end = static_cast<int>(entries_.size());
    columns_.push_back(column);
  }
  for (Entry& entry : entries_) entry.column = position_[entry.column];
}

// Each column's entries in the order of elimination: transposed once, and back.
void BlockMatrix::sortEntries() {
  const int count = static_cast<int>(columns_.size());
  row_start_.assign(count + 1, 0);
  for (const Entry& entry : entries_) ++row_start_[entry.column + 1];
  for (int row = 0; row < count; ++row) row_start_[row + 1] += row_start_[row];
  row_columns_.resize(entries_.size());
  row_entries_.resize(entries_.size());
  filled_.assign(row_start_.begin(), row_start_.end());
  for (int column = 0; column < count; ++column)
    for (int e = columns_[column].first; e < columns_[column].end; ++e) row_columns_[filled_[entries_[e].column]++] = column;
  for (int column = 0; column < count; ++column) filled_[column] = columns_[column].first;
  for (int row = 0; row < count; ++row)
    for (int i = row_start_[row]; i < row_start_[row + 1]; ++i) {
      row_entries_[i] = filled_[row_columns_[i]]++;
      entries_[row_entries_[i]].column = row;
    }
}

void BlockMatrix::place() {
  std::size_t next = 0;
  most_entries_ = 0;
  rows_.resize(entries_.size());
  for (Column& column : columns_) {
    column.diagonal = next;
    column.free = column.size == FREE;
    next += static_cast<std::size_t>(column.size) * column.size;
    most_entries_ = std::max(most_entries_, static_cast<std::size_t>(column.end - column.first));
    for (int e = column.first; e < column.end; ++e) {
      const Column& row = columns_[entries_[e].column];
      column.free = column.free && row.size == FREE;
      rows_[e] = row.offset;
      entries_[e].value = next;
      next += static_cast<std::size_t>(column.size) * row.size;
    }
  }
  values_.resize(next);
  targets_.resize(MOST_CHUNKS * most_entries_);
}

void BlockMatrix::setZero() { std::fill(values_.begin(), values_.end(), 0.0); }

BlockMatrix::Block BlockMatrix::diagonal(int block) {
  const Column& column = columns_[position_[block]];
  return Block(values_.data() + column.diagonal, column.size, column.size);
}

BlockMatrix::Block BlockMatrix::entryBlock(const Column& column, const Entry& entry) {
  return Block(values_.data() + entry.value, columns_[entry.column].size, column.size);
}

Eigen::Map<const Eigen::MatrixXd> BlockMatrix::entryBlock(const Column& column, const Entry& entry) const {
  return Eigen::Map<const Eigen::MatrixXd>(values_.data() + entry.value, columns_[entry.column].size, column.size);
}

BlockMatrix::Entry* BlockMatrix::find(int row, int column) {
  const auto end = entries_.begin() + columns_[column].end;
  return &*std::lower_bound(entries_.begin() + columns_[column].first, end, row, [](const Entry& e, int r) { return e.column < r; });
}

BlockMatrix::Block BlockMatrix::coupling(int a, int b, bool* transposed) {
  const int pa = position_[a], pb = position_[b];
  *transposed = pa < pb;
  const int column = std::min(pa, pb);
  return entryBlock(columns_[column], *find(std::max(pa, pb), column));
}

void BlockMatrix::fold(int block, int from, int to, double factor) {
  Block d = diagonal(block);
  d.triangularView<Eigen::StrictlyUpper>() = d.transpose();
  d.row(to) += factor * d.row(from);
  d.col(to) += factor * d.col(from);
  d.row(from).setZero();
  d.col(from).setZero();
  d(from, from) = 1;
  for (const Column& column : columns_) {
    for (int e = column.first; e < column.end; ++e) {
      Block m = entryBlock(column, entries_[e]);
      if (column.block == block) {
        m.col(to) += factor * m.col(from);
        m.col(from).setZero();
      } else if (columns_[entries_[e].column].block == block) {
        m.row(to) += factor * m.row(from);
        m.row(from).setZero();
      }
    }
  }
}

bool BlockMatrix::factorColumn(const Column& column) {
  double* diagonal = values_.data() + column.diagonal;
  if (column.size == FREE) {
    if (!factorFree(diagonal)) return false;
  } else {
    Block d(diagonal, column.size, column.size);
    if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower>(d).info() != Eigen::Success) return false;
  }
  if (column.free) {
    divideFree(diagonal, column.end - column.first, diagonal + FREE_BLOCK);
    return true;
  }
  for (int e = column.first; e < column.end; ++e) {
    if (column.size == FREE && columns_[entries_[e].column].size == FREE)
      divideFree(diagonal, 1, values_.data() + entries_[e].value);
    else
      divide(entryBlock(column, entries_[e]), Block(diagonal, column.size, column.size));
  }
  return true;
}

// Offsets in values_ of the blocks that couple the neighbour of entry e with those of the column's entries from e on.
void BlockMatrix::findTargets(const Column& column, int e, std::size_t* targets) const {
  const Column& target = columns_[entries_[e].column];
  targets[0] = target.diagonal;
  const int* const rows = rows_.data();
  int slot = target.first;
  for (int f = e + 1; f < column.end; ++f, ++slot) {
    while (rows[slot] != rows[f]) ++slot;
    targets[f - e] = entries_[slot].value;
  }
}

// Subtracts entry e's outer products with the column's entries from e on from the blocks that couple their neighbours.
void BlockMatrix::subtractOuter(const Column& column, int e, std::size_t* targets) {
  double* values = values_.data();
  findTargets(column, e, targets);
  const double* own = values + entries_[e].value;
  if (column.free) return subtractFree(own, own, column.end - e, targets, values);
  const int size = columns_[entries_[e].column].size;
  for (int f = e; f < column.end; ++f) {
    const int rows = columns_[entries_[f].column].size;
    const std::size_t at = targets[f - e];
    if (column.size == FREE && size == FREE && rows == FREE)
      subtractFree(own, values + entries_[f].value, 1, &at, values);
    else
      Block(values + at, rows, size).noalias() -= entryBlock(column, entries_[f]) * entryBlock(column, entries_[e]).transpose();
  }
}

// Left-looking: a column takes the outer products of those before it, in their order, and is factored. Each block's sum is the same
// whichever thread makes it. @param shared other threads factor columns before it
bool BlockMatrix::eliminate(int at, bool shared, std::size_t* targets) {
  if (columns_[at].size == 0) return true;
  for (int i = row_start_[at]; i < row_start_[at + 1]; ++i) {
    const int before = row_columns_[i];
    if (columns_[before].size == 0) continue;
    if (shared)
      for (Wait wait; !done_[before].load(std::memory_order_acquire);) wait.once();
    subtractOuter(columns_[before], row_entries_[i], targets);
  }
  return factorColumn(columns_[at]);
}

// Takes columns while there are any, in their order, so that those that a column waits for are taken. One that fails is as good as done.
bool BlockMatrix::eliminateByTurns(std::size_t* targets, std::atomic<int>* next) {
  bool all = true;
  for (int at = 0; (at = next->fetch_add(1, std::memory_order_relaxed)) < static_cast<int>(columns_.size());) {
    all = eliminate(at, true, targets) && all;
    done_[at].store(1, std::memory_order_release);
  }
  return all;
}

bool BlockMatrix::factor(Team* team) {
  const auto count = static_cast<int>(columns_.size());
  if (!team->isGathered() || entries_.size() < MANY_ENTRIES) {
    for (int at = 0; at < count; ++at)
      if (!eliminate(at, false, targets_.data())) return false;
    return true;
  }
  if (done_room_ < columns_.size()) {
    done_room_ = columns_.size();
    done_ = std::make_unique<std::atomic<char>[]>(done_room_);
  }
  for (int at = 0; at < count; ++at) done_[at].store(0, std::memory_order_relaxed);
  std::atomic<int> next{0}, failed{0};
  team->forChunks(MOST_CHUNKS, [&](int chunk) {
    if (!eliminateByTurns(targets_.data() + chunk * most_entries_, &next)) failed.store(1, std::memory_order_relaxed);
  });
  return failed.load(std::memory_order_relaxed) == 0;
}

void BlockMatrix::forward(const Column& column, Eigen::Ref<Eigen::VectorXd> x) const {
  const double* diagonal = values_.data() + column.diagonal;
  if (column.free)
    return forwardFree({diagonal, column.end - column.first, rows_.data() + column.first}, x.data() + column.offset, x.data());
  auto own = x.segment(column.offset, column.size);
  Eigen::Map<const Eigen::MatrixXd>(diagonal, column.size, column.size).triangularView<Eigen::Lower>().solveInPlace(own);
  for (int e = column.first; e < column.end; ++e)
    x.segment(rows_[e], columns_[entries_[e].column].size) -= entryBlock(column, entries_[e]).lazyProduct(own);
}

void BlockMatrix::backward(const Column& column, Eigen::Ref<Eigen::VectorXd> x) const {
  const double* diagonal = values_.data() + column.diagonal;
  if (column.free)
    return backwardFree({diagonal, column.end - column.first, rows_.data() + column.first}, x.data() + column.offset, x.data());
  auto own = x.segment(column.offset, column.size);
  for (int e = column.first; e < column.end; ++e)
    own -= entryBlock(column, entries_[e]).transpose().lazyProduct(x.segment(rows_[e], columns_[entries_[e].column].size));
  Eigen::Map<const Eigen::MatrixXd>(diagonal, column.size, column.size).transpose().triangularView<Eigen::Upper>().solveInPlace(own);
}

void BlockMatrix::solve(Eigen::Ref<Eigen::VectorXd> x) const {
  for (const Column& column : columns_)
    if (column.size > 0) forward(column, x);
  for (auto column = columns_.rbegin(); column != columns_.rend(); ++column)
    if (column->size > 0) backward(*column, x);
}

}  // namespace blem_sim::dynamics
