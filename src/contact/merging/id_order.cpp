#include "merging/id_order.h"

#include <algorithm>
#include <utility>

#include "blem_sim/geometry/roomy.h"

namespace blem_sim::contact {
namespace {

int widthOf(std::uint64_t value) { return value == 0 ? 0 : 64 - __builtin_clzll(value); }

}  // namespace

const std::vector<IdOrder::Entry>& IdOrder::of(const Contact* contacts, std::size_t count) {
  geometry::resizeRoomy(count, &entries_);
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < count; ++i) {
    entries_[i] = {contacts[i].id, static_cast<std::uint32_t>(i)};
    different |= contacts[i].id ^ contacts[0].id;
  }
  sortByFirstFeature(different);
  if (!insertAll()) {
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& a, const Entry& b) { return a.id != b.id ? a.id < b.id : a.index < b.index; });
  }
  return entries_;
}

/** Digit by digit, since comparing is hard to foresee. @param different bits in which ids differ */
void IdOrder::sortByFirstFeature(std::uint64_t different) {
  constexpr std::size_t FEW = 32;
  constexpr int LONGEST_DIGIT = 9;
  if (entries_.size() <= FEW) return;
  // The fields of contactId: kind, then number.
  const int number_bits = widthOf(different >> 32 & 0x3FFFFFFF), bits = number_bits + 2;
  const std::uint64_t number_mask = (std::uint64_t{1} << number_bits) - 1;
  const int digits = (bits + LONGEST_DIGIT - 1) / LONGEST_DIGIT, digit_bits = (bits + digits - 1) / digits;
  const std::size_t values = std::size_t{1} << digit_bits;
  geometry::resizeRoomy(entries_.size(), &room_);
  for (int shift = 0; shift < bits; shift += digit_bits) {
    const auto digit = [=](const Entry& entry) {
      return (entry.id >> 62 << number_bits | (entry.id >> 32 & number_mask)) >> shift & (values - 1);
    };
    std::uint32_t ends[1 << LONGEST_DIGIT];
    std::fill_n(ends, values, 0u);
    for (const Entry& entry : entries_) ++ends[digit(entry)];
    std::uint32_t end = 0;
    for (std::size_t value = 0; value < values; ++value) end += std::exchange(ends[value], end);
    for (const Entry& entry : entries_) room_[ends[digit(entry)]++] = entry;
    entries_.swap(room_);
  }
}

/** For entries that are nearly sorted. @return false if they are not, and it gave up */
bool IdOrder::insertAll() {
  std::size_t moves_left = 8 * entries_.size();
  for (std::size_t i = 1; i < entries_.size(); ++i) {
    if (entries_[i - 1].id <= entries_[i].id) continue;
    const Entry entry = entries_[i];
    std::size_t place = i;
    for (; place > 0 && entries_[place - 1].id > entry.id; --place) entries_[place] = entries_[place - 1];
    entries_[place] = entry;
    if (i - place > moves_left) return false;
    moves_left -= i - place;
  }
  return true;
}

}  // namespace blem_sim::contact
