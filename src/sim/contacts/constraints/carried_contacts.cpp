#include "contacts/constraints/carried_contacts.h"

#include <algorithm>

#include "contacts/constraints/constraint_maker.h"

namespace blem_sim::sim {
namespace {

constexpr double SAME_WAY = 1e-6;      // of unit vectors
constexpr double AT_ITS_PLACE = 1e-7;  // [m] beside the normal; along it a layer of another width moves the point

Vector3 awayFrom(const contact::Contact& contact, bool of_a) { return of_a ? Vector3(-contact.normal_BA) : contact.normal_BA; }

}  // namespace

void CarriedContacts::add(int surface, int other, const contact::Contact& contact, bool of_a) {
  const std::uint64_t id = worldContactId(of_a ? surface : other, of_a ? other : surface, contact.id);
  carried_.push_back({other, of_a, id, contact.point, awayFrom(contact, of_a)});
}

dynamics::ContactRenames CarriedContacts::onto(int remains, const std::vector<contact::ContactManifold>& manifolds) const {
  dynamics::ContactRenames renames;
  for (const contact::ContactManifold& manifold : manifolds) {
    const bool of_a = manifold.a == remains;
    if (!of_a && manifold.b != remains) continue;
    const int other = of_a ? manifold.b : manifold.a;
    for (const Carried& carried : carried_) {
      if (carried.other != other) continue;
      const auto isSame = [&](const contact::Contact& contact) {
        const Vector3 apart = contact.point - carried.point;
        return (awayFrom(contact, of_a) - carried.away).norm() < SAME_WAY && carried.away.cross(apart).norm() < AT_ITS_PLACE;
      };
      const auto found = std::find_if(manifold.contacts.begin(), manifold.contacts.end(), isSame);
      if (found == manifold.contacts.end()) continue;
      renames.push_back({carried.id, worldContactId(manifold.a, manifold.b, found->id), carried.of_a != of_a});
    }
  }
  return renames;
}

}  // namespace blem_sim::sim
