#include "id_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace blem_sim {
namespace {

int widthOf(std::uint64_t value) { return value == 0 ? 0 : 64 - __builtin_clzll(value); }

std::uint64_t maskOf(int bits) { return (std::uint64_t{1} << bits) - 1; }

}  // namespace

const std::vector<std::uint32_t>& IdOrder::of(const Contact* contacts, std::size_t count) {
  order_.resize(count);
  if (pack(contacts, count)) {
    sortKeys();
    for (std::size_t i = 0; i < count; ++i) order_[i] = static_cast<std::uint32_t>(keys_[i] & maskOf(index_bits_));
  } else {
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), [contacts](std::uint32_t a, std::uint32_t b) {
      return contacts[a].id != contacts[b].id ? contacts[a].id < contacts[b].id : a < b;
    });
  }
  return order_;
}

/** @return false if ids and indices need more bits than a key has */
bool IdOrder::pack(const Contact* contacts, std::size_t count) {
  keys_.resize(count);
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < count; ++i) {
    keys_[i] = contacts[i].id;
    different |= keys_[i] ^ keys_[0];
  }
  // The fields of contactId, each with the bits that it needs.
  const int a_bits = widthOf(different >> 32 & maskOf(30)), kind_bits = widthOf(different >> 30 & 3),
            b_bits = widthOf(different & maskOf(30));
  index_bits_ = widthOf(count);
  key_bits_ = 2 + a_bits + kind_bits + b_bits;
  if (key_bits_ + index_bits_ > 64) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t id = keys_[i];
    std::uint64_t key = id >> 62;
    key = key << a_bits | (id >> 32 & maskOf(a_bits));
    key = key << kind_bits | (id >> 30 & maskOf(kind_bits));
    key = key << b_bits | (id & maskOf(b_bits));
    keys_[i] = key << index_bits_ | i;
  }
  return true;
}

/** Digit by digit, since comparing is hard to foresee; they are in the order of their indices already. */
void IdOrder::sortKeys() {
  constexpr std::size_t FEW = 32;
  constexpr int DIGIT = 7, DIGITS = (64 + DIGIT - 1) / DIGIT, VALUES = 1 << DIGIT;
  if (keys_.size() <= FEW) {
    std::sort(keys_.begin(), keys_.end());
    return;
  }
  room_.resize(keys_.size());
  const int digits = (key_bits_ + DIGIT - 1) / DIGIT;
  std::uint32_t ends[DIGITS][VALUES];
  std::fill_n(&ends[0][0], digits * VALUES, 0u);
  for (const std::uint64_t key : keys_) {
    std::uint64_t left = key >> index_bits_;
    for (int i = 0; i < digits; ++i, left >>= DIGIT) ++ends[i][left & (VALUES - 1)];
  }
  for (int i = 0; i < digits; ++i) {
    const int shift = index_bits_ + i * DIGIT;
    std::uint32_t end = 0;
    for (std::uint32_t& each : ends[i]) end += std::exchange(each, end);
    for (const std::uint64_t key : keys_) room_[ends[i][key >> shift & (VALUES - 1)]++] = key;
    keys_.swap(room_);
  }
}

}  // namespace blem_sim
