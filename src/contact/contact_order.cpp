#include "blem_sim/contact/contact_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace blem_sim::contact {

namespace {

constexpr double SHORTEST_NORMAL = 1e-9;  // below, a normal has no direction to trust

// <0, 0, >0 as a is before, equal to, after b
int compare(const Vector3& a, const Vector3& b) {
  for (int i = 0; i < 3; ++i) {
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  }
  return 0;
}

bool isUsable(const Contact& c) {
  return c.point.allFinite() && c.normal_BA.allFinite() && std::isfinite(c.depth) && c.normal_BA.norm() > SHORTEST_NORMAL;
}

}  // namespace

bool contactBefore(const Contact& a, const Contact& b) {
  if (a.id != b.id) return a.id < b.id;
  if (const int order = compare(a.point, b.point)) return order < 0;
  if (const int order = compare(a.normal_BA, b.normal_BA)) return order < 0;
  if (a.depth != b.depth) return a.depth < b.depth;
  return a.pierced < b.pierced;
}

void makeUsable(std::vector<Contact>& contacts) {
  contacts.erase(std::remove_if(contacts.begin(), contacts.end(), [](const Contact& c) { return !isUsable(c); }), contacts.end());
  for (Contact& contact : contacts) {
    // A normal that is unit already keeps its bits: reducing twice changes nothing.
    const double length = contact.normal_BA.norm();
    if (std::abs(length - 1.0) > 1e-14) contact.normal_BA /= length;
  }
}

void makeCanonical(std::vector<Contact>& contacts) {
  makeUsable(contacts);
  if (!std::is_sorted(contacts.begin(), contacts.end(), contactBefore)) std::sort(contacts.begin(), contacts.end(), contactBefore);
}

void CanonicalOrder::sort(const std::vector<Contact>& contacts, std::vector<int>* indices) {
  keys_.clear();
  for (const int index : *indices) keys_.push_back({contacts[index].id, index});
  std::sort(keys_.begin(), keys_.end(),
            [&](const Key& a, const Key& b) { return a.id != b.id ? a.id < b.id : contactBefore(contacts[a.index], contacts[b.index]); });
  for (std::size_t i = 0; i < keys_.size(); ++i) (*indices)[i] = keys_[i].index;
}

}  // namespace blem_sim::contact
