// Reading the numbers of a saved state.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::sim {

/** Reads in the order of writing; throws InputError where the numbers end too early, are not finite, or cannot be. */
class NumberReader {
 public:
  explicit NumberReader(const std::vector<double>& numbers) : next_(numbers.data()), end_(next_ + numbers.size()) {}

  std::size_t left() const { return static_cast<std::size_t>(end_ - next_); }
  double number() {
    double number;
    numbers(&number, 1);
    return number;
  }
  void numbers(double* out, std::size_t count) {
    require(count);
    for (const double* end = next_ + count; next_ != end; ++next_, ++out) {
      if (!std::isfinite(*next_)) refuseContent("a number is not finite");
      *out = *next_;
    }
  }
  /** One of `count` alternatives. */
  int choice(int count) {
    const double number = this->number();
    if (!(number >= 0 && number < count) || number != std::floor(number)) refuseContent("a choice is none of those there are");
    return static_cast<int>(number);
  }
  /** Throws unless `count` numbers are left. */
  void require(std::size_t count) const {
    if (left() < count) refuse();
  }
  /** Throws unless everything was read. */
  void finish() const {
    if (left() > 0) refuse();
  }
  [[noreturn]] static void refuse() { throw InputError("restore: the state is cut short, or not of these models; save it again"); }
  /** @param what names the fault */
  [[noreturn]] static void refuseContent(const char* what) {
    throw InputError(std::string("restore: the state's content cannot be, ") + what + "; save it again");
  }

 private:
  const double *next_, *end_;
};

}  // namespace blem_sim::sim
