#include "block_matrix.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace blem_sim {
namespace {

constexpr int FREE = 6;  // dofs of a free body, by far the most frequent block
using FreeBlock = Eigen::Matrix<double, FREE, FREE>;
using FreeMap = Eigen::Map<FreeBlock>;

bool factorFree(double* values) {
  FreeMap a(values);
  for (int k = 0; k < FREE; ++k) {
    if (!(a(k, k) > 0)) return false;
    a(k, k) = std::sqrt(a(k, k));
    const double inverse = 1 / a(k, k);
    for (int i = k + 1; i < FREE; ++i) a(i, k) *= inverse;
    for (int j = k + 1; j < FREE; ++j)
      for (int i = j; i < FREE; ++i) a(i, j) -= a(i, k) * a(j, k);
  }
  return true;
}

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
  adjacent_.assign(sizes_.size() * sizes_.size(), 0);
}

void BlockMatrix::couple(int a, int b) { adjacent_[a * sizes_.size() + b] = adjacent_[b * sizes_.size() + a] = 1; }

int BlockMatrix::degree(int block) const {
  int degree = 0;
  const char* row = adjacent_.data() + block * sizes_.size();
  for (std::size_t other = 0; other < sizes_.size(); ++other)
    if (row[other] && position_[other] < 0) degree += sizes_[other];
  return degree;
}

void BlockMatrix::eliminate(int block) {
  Column column;
  column.block = block;
  column.size = sizes_[block];
  column.offset = offsets_[block];
  column.first = static_cast<int>(entries_.size());
  position_[block] = static_cast<int>(columns_.size());
  neighbours_.clear();
  const std::size_t count = sizes_.size();
  for (std::size_t other = 0; other < count; ++other)
    if (adjacent_[block * count + other] && position_[other] < 0) neighbours_.push_back(static_cast<int>(other));
  for (const int other : neighbours_) entries_.push_back({other, 0});
  column.end = static_cast<int>(entries_.size());
  columns_.push_back(column);
  for (const int a : neighbours_)
    for (const int b : neighbours_)
      if (a != b) adjacent_[a * count + b] = 1;
  for (const int other : neighbours_) degrees_[other] = degree(other);
}

void BlockMatrix::analyse() {
  const int count = static_cast<int>(sizes_.size());
  position_.assign(count, -1);
  columns_.clear();
  entries_.clear();
  degrees_.resize(count);
  for (int block = 0; block < count; ++block) degrees_[block] = degree(block);
  for (int k = 0; k < count; ++k) {
    int least = -1;
    for (int block = 0; block < count; ++block)
      if (position_[block] < 0 && (least < 0 || degrees_[block] <= degrees_[least])) least = block;
    eliminate(least);
  }
  place();
}

void BlockMatrix::place() {
  for (Entry& entry : entries_) entry.column = position_[entry.column];
  std::size_t next = 0;
  for (Column& column : columns_) {
    std::sort(entries_.begin() + column.first, entries_.begin() + column.end,
              [](const Entry& p, const Entry& q) { return p.column < q.column; });
    column.diagonal = next;
    next += static_cast<std::size_t>(column.size) * column.size;
    for (int e = column.first; e < column.end; ++e) {
      entries_[e].value = next;
      next += static_cast<std::size_t>(column.size) * columns_[entries_[e].column].size;
    }
  }
  values_.resize(next);
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
  for (int e = column.first; e < column.end; ++e) {
    if (column.size == FREE && columns_[entries_[e].column].size == FREE)
      divide(FreeMap(values_.data() + entries_[e].value), FreeMap(diagonal));
    else
      divide(entryBlock(column, entries_[e]), Block(diagonal, column.size, column.size));
  }
  return true;
}

// What the column's elimination takes from the blocks that its neighbours share.
void BlockMatrix::subtractOuter(const Column& column) {
  for (int e = column.first; e < column.end; ++e) {
    const Column& target = columns_[entries_[e].column];
    int slot = target.first;
    for (int f = e; f < column.end; ++f) {
      std::size_t at = target.diagonal;
      if (f > e) {
        while (entries_[slot].column != entries_[f].column) ++slot;
        at = entries_[slot].value;
      }
      const int rows = columns_[entries_[f].column].size;
      double* values = values_.data();
      if (column.size == FREE && target.size == FREE && rows == FREE)
        FreeMap(values + at).noalias() -= FreeMap(values + entries_[f].value) * FreeMap(values + entries_[e].value).transpose();
      else
        Block(values + at, rows, target.size).noalias() -= entryBlock(column, entries_[f]) * entryBlock(column, entries_[e]).transpose();
    }
  }
}

bool BlockMatrix::factor() {
  for (const Column& column : columns_) {
    if (column.size == 0) continue;
    if (!factorColumn(column)) return false;
    subtractOuter(column);
  }
  return true;
}

void BlockMatrix::solve(Eigen::Ref<Eigen::VectorXd> x) const {
  const auto part = [&x](const Column& column) { return x.segment(column.offset, column.size); };
  const auto factorOf = [this](const Column& c) { return Eigen::Map<const Eigen::MatrixXd>(values_.data() + c.diagonal, c.size, c.size); };
  for (const Column& column : columns_) {
    if (column.size == 0) continue;
    auto own = part(column);
    factorOf(column).triangularView<Eigen::Lower>().solveInPlace(own);
    for (int e = column.first; e < column.end; ++e) part(columns_[entries_[e].column]) -= entryBlock(column, entries_[e]).lazyProduct(own);
  }
  for (auto column = columns_.rbegin(); column != columns_.rend(); ++column) {
    if (column->size == 0) continue;
    auto own = part(*column);
    for (int e = column->first; e < column->end; ++e)
      own -= entryBlock(*column, entries_[e]).transpose().lazyProduct(part(columns_[entries_[e].column]));
    factorOf(*column).transpose().triangularView<Eigen::Upper>().solveInPlace(own);
  }
}

}  // namespace blem_sim
