// Filter for the contacts that are among some that are named.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "blem_sim/reduction/reduction.h"

namespace blem_sim::reduction {

/** Ids, most of which can be told from others without a search. */
class IdFilter {
 public:
  /** @param ids are to outlive it */
  explicit IdFilter(const ContactIds& ids) : ids_(ids) {
    bits_.fill(0);
    for (const std::uint64_t id : ids) bits_[slot(id) / 64] |= std::uint64_t{1} << slot(id) % 64;
  }
  bool has(std::uint64_t id) const { return mayHave(bits_.data(), id) && std::binary_search(ids_.begin(), ids_.end(), id); }

  const std::uint64_t* bits() const { return bits_.data(); }
  /** False if the filter surely does not have the id. @param bits of a filter */
  static bool mayHave(const std::uint64_t* bits, std::uint64_t id) { return bits[slot(id) / 64] >> slot(id) % 64 & 1; }

 private:
  static std::uint64_t slot(std::uint64_t id) { return id * 0x9E3779B97F4A7C15ull >> 52; }
  const ContactIds& ids_;
  std::array<std::uint64_t, 64> bits_;
};

}  // namespace blem_sim::reduction
