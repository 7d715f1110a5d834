// Saved states: one writer and one reader for all rooms.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/types.h"

namespace blem_sim::geometry {

/** Lists of a part of a state. */
struct StateContent {
  std::vector<double> numbers;
  std::vector<std::uint64_t> words;
};

/** Appends to the two lists of a state, its numbers and its words of 64 bits. */
class StateWriter {
 public:
  /** @tparam State has the lists `numbers` and `words` */
  template <typename State>
  explicit StateWriter(State* state) : numbers_(&state->numbers), words_(&state->words) {}

  void number(double x) { numbers_->push_back(x); }
  void numbers(const double* x, std::size_t count) { numbers_->insert(numbers_->end(), x, x + count); }
  void numbers(std::initializer_list<double> x) { numbers_->insert(numbers_->end(), x); }
  void vector(const Vector3& v) { numbers(v.data(), 3); }
  void word(std::uint64_t word) { words_->push_back(word); }
  void words(const std::vector<std::uint64_t>& words) { words_->insert(words_->end(), words.begin(), words.end()); }
  /** Counts and indices of at least 0. */
  void integer(int i) { word(static_cast<std::uint64_t>(i)); }
  /** A word, 0 or 1. */
  void flag(bool flag) { word(flag ? 1 : 0); }

 private:
  std::vector<double>* numbers_;
  std::vector<std::uint64_t>* words_;
};

/** Reads from each list in the order of writing. A list that ends too early is refused; limits of what is read are the caller's to check.
 */
class StateReader {
 public:
  static constexpr const char* CUT_SHORT = "restore: the state is cut short, or not of these models; save it again";

  /**
   * @tparam State has the lists `numbers` and `words`, which are read in place
   * @param not_ours one line about a state that ends too early, is too long or was saved elsewhere
   */
  template <typename State>
  explicit StateReader(const State& state, const char* not_ours = CUT_SHORT)
      : next_number_(state.numbers.data()),
        numbers_end_(next_number_ + state.numbers.size()),
        next_word_(state.words.data()),
        words_end_(next_word_ + state.words.size()),
        not_ours_(not_ours) {}

  std::size_t numbersLeft() const { return static_cast<std::size_t>(numbers_end_ - next_number_); }
  std::size_t wordsLeft() const { return static_cast<std::size_t>(words_end_ - next_word_); }

  double number() {
    requireNumbers(1);
    return *next_number_++;
  }
  void numbers(double* x, std::size_t count) {
    requireNumbers(count);
    std::copy_n(next_number_, count, x);
    next_number_ += count;
  }
  Vector3 vector() {
    Vector3 v;
    numbers(v.data(), 3);
    return v;
  }
  /** A number that is one of 0, 1 ... below `count`. */
  int choice(int count) {
    const double x = number();
    if (!(x >= 0 && x < count) || x != std::floor(x)) refuseContent("a choice is none of those there are");
    return static_cast<int>(x);
  }
  std::uint64_t word() {
    requireWords(1);
    return *next_word_++;
  }
  std::vector<std::uint64_t> words(std::size_t count) {
    requireWords(count);
    next_word_ += count;
    return {next_word_ - count, next_word_};
  }
  /** A word that is 0 or 1. */
  bool flag() {
    const std::uint64_t flag = word();
    if (flag > 1) refuseContent("a flag is neither 0 nor 1");
    return flag == 1;
  }
  /** A word that counts items of so many words and numbers each; refused if the rest of the state cannot hold them. */
  std::size_t count(std::size_t words_each, std::size_t numbers_each) {
    const std::uint64_t items = word();
    if (words_each > 0 && items > wordsLeft() / words_each) refuse();
    if (numbers_each > 0 && items > numbersLeft() / numbers_each) refuse();
    return static_cast<std::size_t>(items);
  }

  void requireNumbers(std::size_t count) const {
    if (numbersLeft() < count) refuse();
  }
  /** Refuses a state that comes from outside if a number that is still to be read is not finite. */
  void requireFinite() const {
    if (!std::all_of(next_number_, numbers_end_, [](double x) { return std::isfinite(x); })) refuseContent("a number is not finite");
  }
  /** Refuses a state of which something is left. */
  void finish() const {
    if (numbersLeft() > 0 || wordsLeft() > 0) refuse();
  }
  /** @throws InputError the state ends too early, is too long or was saved elsewhere */
  [[noreturn]] void refuse() const { throw InputError(not_ours_); }
  /** @param what names the fault @throws InputError */
  [[noreturn]] void refuseContent(const char* what) const {
    throw InputError(std::string("restore: the state's content cannot be, ") + what + "; save it again");
  }

 private:
  void requireWords(std::size_t count) const {
    if (wordsLeft() < count) refuse();
  }

  const double *next_number_, *numbers_end_;
  const std::uint64_t *next_word_, *words_end_;
  const char* not_ours_;
};

}  // namespace blem_sim::geometry
