#include "patches/patch_frame.h"

#include <algorithm>
#include <limits>

#include "lanes/contact_row.h"

namespace blem_sim::reduction {

namespace {

constexpr double SMALLEST = 1e-6;  // [m] radius
constexpr double UNIT = 1.9e-14;   // squares of lengths are 1 within it

// The least and the largest numbers of the contacts. @return whether all are finite, with unit normals
BLEM_SIM_LANES bool findSpan(const contact::Contact* contacts, std::size_t count, ContactRow* lowest, ContactRow* highest) {
  constexpr double INFINITE = std::numeric_limits<double>::infinity();
  ContactRow low{Doubles{} + INFINITE, Doubles{} + INFINITE}, high{-low.first, -low.second};
  Doubles nothing = {};  // 0 while all are finite
  int unready = 0;
  for (std::size_t i = 0; i < count; ++i) {
    ContactRow row;
    readRow(contacts[i], &row);
    low.first = row.first < low.first ? row.first : low.first;
    high.first = row.first > high.first ? row.first : high.first;
    high.second = row.second > high.second ? row.second : high.second;
    nothing += 0 * row.first + 0 * row.second;
    const double* n = contacts[i].normal_BA.data();
    const double excess = n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1;
    unready |= !((excess < 0 ? -excess : excess) <= UNIT);
  }
  *lowest = low;
  *highest = high;
  for (int i = 0; i < 4; ++i) unready |= !(nothing[i] == 0);
  return !unready;
}

}  // namespace

PatchScale::PatchScale(const std::vector<contact::Contact>& contacts, bool* ready) {
  ContactRow low, high;
  *ready = findSpan(contacts.data(), contacts.size(), &low, &high);
  if (!*ready || contacts.empty()) return;
  const Vector3 lowest(low.first[0], low.first[1], low.first[2]), highest(high.first[0], high.first[1], high.first[2]);
  centre_ = 0.5 * (lowest + highest);
  per_radius_ = 1 / std::max(0.5 * (highest - lowest).norm(), SMALLEST);
  depth_ = high.second[2];
}

}  // namespace blem_sim::reduction
