#include "merging/merge_contacts.h"

#include <cstdint>
#include <tuple>
#include <vector>

#include "features/tolerances.h"

namespace blem_sim::contact {
namespace {

/** Total order of contacts of one id: the one to keep comes first. */
bool keptBefore(const Contact& a, const Contact& b) {
  const auto key = [](const Contact& c) { return std::make_tuple(!c.pierced, -c.depth, c.point.x(), c.point.y(), c.point.z()); };
  return key(a) < key(b);
}

/** @param place of a, instead of its own */
bool coincide(const Contact& a, const Vector3& place, const Contact& b) {
  const double distance2 = (place - b.point).squaredNorm(), sine2 = (a.normal_BA - b.normal_BA).squaredNorm();
  return (a.pierced == b.pierced) & (distance2 <= MERGE_DISTANCE * MERGE_DISTANCE) & (sine2 <= MERGE_SINE * MERGE_SINE);
}

/** The best of those from `first` on that share its id. @param next the first one of another id */
std::uint32_t bestOfId(const Contact* contacts, const std::vector<IdOrder::Entry>& by_id, std::size_t first, std::size_t* next) {
  std::uint32_t best = by_id[first].index;
  for (*next = first + 1; *next < by_id.size() && by_id[*next].id == by_id[first].id; ++*next) {
    const std::uint32_t other = by_id[*next].index;
    if (keptBefore(contacts[other], contacts[best])) best = other;
  }
  return best;
}

}  // namespace

std::size_t ContactMerge::run(const Contact* contacts, std::size_t count, Contact* merged) {
  if (count == 0) return 0;
  const std::vector<IdOrder::Entry>& by_id = by_id_.of(contacts, count);
  places_.begin(contacts, count);
  std::size_t left = 0;
  for (std::size_t i = 0; i < count;) {
    const std::uint32_t index = bestOfId(contacts, by_id, i, &i);
    const Contact& contact = contacts[index];
    const bool is_merged = places_.visitOrAdd(index, [&](std::uint32_t number, const Vector3& place) {
      Contact& other = merged[number];
      if (!coincide(other, place, contact)) return false;
      const std::uint64_t id = other.id;
      other = contact.depth > other.depth ? contact : other;
      other.id = id;
      return true;
    });
    if (!is_merged) merged[left++] = contact;
  }
  return left;
}

}  // namespace blem_sim::contact
