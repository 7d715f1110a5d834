#include "sensors/types/link_contacts.h"

#include <algorithm>
#include <tuple>

namespace blem_sim::sim {
namespace {

auto linkOf(const LinkContacts::Entry& entry) { return std::make_tuple(entry.model, entry.link); }
auto placeOf(const LinkContacts::Entry& entry) { return std::make_tuple(entry.model, entry.link, entry.contact); }

struct ByLink {
  bool operator()(const LinkContacts::Entry& a, const LinkContacts::Entry& b) const { return linkOf(a) < linkOf(b); }
};

}  // namespace

Wrench wrenchOfContact(const ContactReport& contact, bool on_a, const Vector3& p_WO) {
  const Vector3 force = on_a ? contact.force : Vector3(-contact.force);
  return {force, (contact.point - p_WO).cross(force) + (on_a ? contact.moment_a : contact.moment_b)};
}

void LinkContacts::index(const SimulatedWorld& world, const std::vector<ContactReport>& contacts) {
  entries_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const contact::Collider &a = world.colliders[contacts[i].collider_a], &b = world.colliders[contacts[i].collider_b];
    const Entry on_a{a.model, a.link, static_cast<int>(i), true}, on_b{b.model, b.link, static_cast<int>(i), false};
    entries_.push_back(on_a);
    if (linkOf(on_a) != linkOf(on_b)) entries_.push_back(on_b);
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return placeOf(a) < placeOf(b); });
}

LinkContacts::Range LinkContacts::of(int model, int link) const {
  const auto range = std::equal_range(entries_.begin(), entries_.end(), Entry{model, link, 0, false}, ByLink());
  return {entries_.data() + (range.first - entries_.begin()), entries_.data() + (range.second - entries_.begin())};
}

}  // namespace blem_sim::sim
