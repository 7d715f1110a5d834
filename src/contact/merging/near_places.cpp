#include "merging/near_places.h"

#include <cstring>

#include "blem_sim/contact/contact_order.h"
#include "blem_sim/geometry/roomy.h"
#include "features/tolerances.h"

namespace blem_sim::contact {
namespace {

constexpr double WIDTH = 16 * MERGE_DISTANCE;             // thin, yet seldom with two within reach
constexpr double REACH = 1.001 * MERGE_DISTANCE / WIDTH;  // in slabs, with room for rounding

/** The whole number nearest to a value, but for a constant: hashes ask for no more. */
std::uint64_t nearest(double value) {
  const double sum = value + 0x1.8p52;
  std::uint64_t bits;
  std::memcpy(&bits, &sum, sizeof bits);
  return bits;
}

}  // namespace

void NearPlaces::begin(const Contact* contacts, std::size_t count) {
  contacts_ = contacts;
  count_ = 0;
  geometry::resizeRoomy(count, &added_);
  geometry::resizeRoomy(count, &slots_);
  int bits = 4;
  while (std::size_t{1} << bits < 4 * count) ++bits;
  last_.clear();
  geometry::resizeRoomy(std::size_t{1} << bits, &last_);  // with NONE
  const auto slot = [bits](std::uint64_t slab) { return static_cast<std::uint32_t>(slab * 0x9E3779B97F4A7C15u >> (64 - bits)); };
  const Vector3 across = UNCOMMON_DIRECTION / WIDTH;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = across.dot(contacts[i].point);
    const std::uint64_t own = nearest(place), low = nearest(place - REACH), high = nearest(place + REACH);
    slots_[i] = {slot(own), slot(low ^ high ^ own)};
  }
}

}  // namespace blem_sim::contact
