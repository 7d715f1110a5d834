// Elimination order of the blocks of a sparse symmetric matrix, and the couplings that elimination fills in.
#pragma once

#include <cstdint>
#include <vector>

namespace blem_sim::dynamics {

/**
 * Least degree first [Tinney and Walker 1967]; a block's degree is the number of rows of the blocks that it is coupled with by then. Of
 * equal ones the last block goes first. Couplings are rows of bits, 64 blocks a word: n^2 / 8 bytes for n blocks.
 */
class EliminationOrder {
 public:
  void start(const std::vector<int>& sizes);
  void couple(int a, int b);
  bool finished() const { return left_ == 0; }
  /** Eliminates the next block. @param neighbours those that it is coupled with and that are not yet eliminated, ascending */
  int next(std::vector<int>* neighbours);

 private:
  using Word = std::uint64_t;
  static constexpr int BITS = 64;
  Word* row(int block) { return coupled_.data() + static_cast<std::size_t>(block) * words_; }
  void rank(int block);
  void tie(int block, int eliminated);

  int count_ = 0, left_ = 0, words_ = 0, leaves_ = 0;
  std::vector<int> sizes_, degrees_;
  std::vector<Word> coupled_;         // a row per block
  std::vector<std::uint64_t> least_;  // a binary tree of minima: degree, then place from the end; leaves last
  std::vector<int> words_of_;         // those of the present block's row that are not zero
};

}  // namespace blem_sim::dynamics
