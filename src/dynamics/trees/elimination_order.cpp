#include "trees/elimination_order.h"

#include <algorithm>

namespace blem_sim::dynamics {
namespace {

constexpr std::uint64_t ELIMINATED = ~0ull;
constexpr int PLACE_BITS = 32;

}  // namespace

void EliminationOrder::start(const std::vector<int>& sizes) {
  sizes_ = sizes;
  count_ = left_ = static_cast<int>(sizes.size());
  words_ = (count_ + BITS - 1) / BITS;
  coupled_.assign(static_cast<std::size_t>(count_) * words_, 0);
  degrees_.assign(count_, 0);
  for (leaves_ = 1; leaves_ < count_;) leaves_ *= 2;
  least_.assign(2 * static_cast<std::size_t>(leaves_), ELIMINATED);
  for (int block = 0; block < count_; ++block) least_[leaves_ + block] = static_cast<std::uint64_t>(count_ - 1 - block);
  for (int node = leaves_ - 1; node > 0; --node) least_[node] = std::min(least_[2 * node], least_[2 * node + 1]);
}

void EliminationOrder::couple(int a, int b) {
  Word& word = row(a)[b / BITS];
  const Word bit = Word{1} << (b % BITS);
  if (word & bit) return;
  word |= bit;
  row(b)[a / BITS] |= Word{1} << (a % BITS);
  degrees_[a] += sizes_[b];
  degrees_[b] += sizes_[a];
  rank(a);
  rank(b);
}

void EliminationOrder::rank(int block) {
  int node = leaves_ + block;
  least_[node] = (static_cast<std::uint64_t>(degrees_[block]) << PLACE_BITS) + static_cast<std::uint64_t>(count_ - 1 - block);
  for (node /= 2; node > 0; node /= 2) {
    const std::uint64_t least = std::min(least_[2 * node], least_[2 * node + 1]);
    if (least == least_[node]) return;
    least_[node] = least;
  }
}

// The neighbours of a block that is eliminated are all coupled from then on.
void EliminationOrder::tie(int block, int eliminated) {
  Word* own = row(block);
  const Word* met = row(eliminated);
  int degree = degrees_[block] - sizes_[eliminated];
  for (const int w : words_of_) {
    Word fresh = met[w] & ~own[w];
    if (w == block / BITS) fresh &= ~(Word{1} << (block % BITS));
    own[w] |= fresh;
    for (; fresh; fresh &= fresh - 1) degree += sizes_[w * BITS + __builtin_ctzll(fresh)];
  }
  own[eliminated / BITS] &= ~(Word{1} << (eliminated % BITS));
  degrees_[block] = degree;
  rank(block);
}

int EliminationOrder::next(std::vector<int>* neighbours) {
  const int block = count_ - 1 - static_cast<int>(least_[1] & 0xffffffffu);
  --left_;
  neighbours->clear();
  words_of_.clear();
  const Word* met = row(block);
  for (int w = 0; w < words_; ++w) {
    if (met[w]) words_of_.push_back(w);
    for (Word word = met[w]; word; word &= word - 1) neighbours->push_back(w * BITS + __builtin_ctzll(word));
  }
  least_[leaves_ + block] = ELIMINATED;
  for (int node = (leaves_ + block) / 2; node > 0; node /= 2) least_[node] = std::min(least_[2 * node], least_[2 * node + 1]);
  for (const int other : *neighbours) tie(other, block);
  return block;
}

}  // namespace blem_sim::dynamics
