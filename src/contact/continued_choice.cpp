#include "continued_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "id_filter.h"
#include "wrench_bounds.h"

namespace blem_sim {

namespace {

constexpr double MOST_LACK = GOOD_ENOUGH - ROUNDING;  // of a unit force
constexpr double FARTHEST = 1000;                     // [unit forces] larger handicaps are rounded by more than ROUNDING

/** Where a contact pushes, in radii, and how much less its wrenches count, in unit forces. */
struct Push {
  Vector3 x, n;
  double handicap;
};

Push pushOf(const Contact& contact, const PatchScale& scale) {
  return {scale.lever(contact.point), contact.normal_BA, std::max(0.0, -contact.depth) * PER_GAP};
}

// A largest component is a convex function of place: between two places it is no larger than the weighted mean of theirs.
bool addsLittleBetween(const Push& push, const Push& a, const Push& b) {
  const Vector3 way = b.x - a.x, from_a = push.x - a.x;
  const double length2 = way.squaredNorm(), t = length2 > 0 ? std::clamp(from_a.dot(way) / length2, 0.0, 1.0) : 0.0;
  const double aside = (from_a - t * way).norm(), tilt = (1 - t) * (push.n - a.n).norm() + t * (push.n - b.n).norm();
  return PER_PLACE * aside + PER_NORMAL * tilt + (1 - t) * a.handicap + t * b.handicap - push.handicap <= MOST_LACK;
}

bool addsLittleBeside(const Push& push, const Push& other) {
  const double room = MOST_LACK + push.handicap - other.handicap;
  if (room < 0 || PER_PLACE * PER_PLACE * (push.x - other.x).squaredNorm() > room * room) return false;
  return PER_PLACE * (push.x - other.x).norm() + PER_NORMAL * (push.n - other.n).norm() <= room;
}

/** Contacts chosen before among the members. */
struct Before {
  std::vector<int> places;  // in the list of members, ascending
  std::vector<Push> pushes;

  /** @return false if they are not k */
  bool find(const std::vector<Contact>& contacts, const std::vector<int>& members, const PatchScale& scale, int k, const ContactIds& ids) {
    if (static_cast<int>(ids.size()) != k) return false;
    const IdFilter filter(ids);
    places.clear();
    pushes.clear();
    for (int m = 0; m < static_cast<int>(members.size()); ++m) {
      const Contact& contact = contacts[members[m]];
      if (!filter.has(contact.id)) continue;
      places.push_back(m);
      pushes.push_back(pushOf(contact, scale));
    }
    return static_cast<int>(places.size()) == k;
  }

  bool span(const Push& push, std::size_t following) const {
    const Push &next = pushes[following % pushes.size()], &last = pushes[(following + pushes.size() - 1) % pushes.size()];
    if (push.handicap > FARTHEST) return false;
    return addsLittleBetween(push, last, next) ||
           std::any_of(pushes.begin(), pushes.end(), [&](const Push& other) { return addsLittleBeside(push, other); });
  }
};

}  // namespace

bool surelyGoesOn(const std::vector<Contact>& contacts, const std::vector<int>& members, const PatchScale& scale, int k,
                  const ContactIds& chosen_before, std::vector<int>* chosen) {
  static thread_local Before before;
  if (!before.find(contacts, members, scale, k, chosen_before)) return false;
  double depth = -std::numeric_limits<double>::infinity();
  chosen->clear();
  for (const int place : before.places) {
    chosen->push_back(members[place]);
    depth = std::max(depth, contacts[members[place]].depth);
  }
  if (depth < scale.depth() - DEEP_ENOUGH) return false;
  std::size_t following = 0;  // the first of those chosen before that comes after the member
  for (int m = 0; m < static_cast<int>(members.size()); ++m) {
    if (following < before.places.size() && before.places[following] == m) {
      ++following;
    } else if (!before.span(pushOf(contacts[members[m]], scale), following)) {
      return false;
    }
  }
  return true;
}

}  // namespace blem_sim
