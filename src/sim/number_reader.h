// Reading the numbers of a saved state.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim {

/** Reads in the order of writing; throws InputError where the numbers end too early. */
class NumberReader {
 public:
  explicit NumberReader(const std::vector<double>& numbers) : next_(numbers.data()), end_(next_ + numbers.size()) {}

  std::size_t left() const { return static_cast<std::size_t>(end_ - next_); }
  double number() {
    require(1);
    return *next_++;
  }
  void numbers(double* out, std::size_t count) {
    require(count);
    std::copy_n(next_, count, out);
    next_ += count;
  }
  /** Throws unless so many are left. */
  void require(std::size_t count) const {
    if (left() < count) refuse();
  }
  /** Throws unless everything was read. */
  void finish() const {
    if (left() > 0) refuse();
  }
  [[noreturn]] static void refuse() { throw InputError("restore: the state is cut short, or not of these models; save it again"); }

 private:
  const double *next_, *end_;
};

}  // namespace blem_sim
