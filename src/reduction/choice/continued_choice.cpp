#include "choice/continued_choice.h"

#include <algorithm>
#include <limits>

#include "choice/id_filter.h"
#include "lanes/reduction_lanes.h"
#include "lanes/wrench_bounds.h"

namespace blem_sim::reduction {

namespace {

constexpr float MOST_LACK = GOOD_ENOUGH - ROUNDING;  // part of a unit force
constexpr float FARTHEST = 1000;                     // [unit forces] larger handicaps are rounded by more than ROUNDING

// A largest component is a convex function of place: between two places it is no larger than the weighted mean of theirs.
bool addsLittleBetween(const WrenchPoint& point, const WrenchPoint& a, const WrenchPoint& b) {
  float along = 0, length2 = 0;
  for (int axis = 0; axis < 3; ++axis) {
    along += (point.x[axis] - a.x[axis]) * (b.x[axis] - a.x[axis]);
    length2 += (b.x[axis] - a.x[axis]) * (b.x[axis] - a.x[axis]);
  }
  const float t = length2 > 0 ? std::clamp(along / length2, 0.0f, 1.0f) : 0.0f;
  float between[3];
  for (int axis = 0; axis < 3; ++axis) between[axis] = a.x[axis] + t * (b.x[axis] - a.x[axis]);
  const float tilt = (1 - t) * distance(point.n, a.n) + t * distance(point.n, b.n);
  const float lead = (1 - t) * a.handicap + t * b.handicap - point.handicap;
  return PER_PLACE * distance(point.x, between) + PER_NORMAL * tilt + lead <= MOST_LACK;
}

/** Contacts chosen before among the members. */
struct Before {
  std::vector<int> places;  // in the list of members, ascending
  std::vector<WrenchPoint> points;
  WrenchPointRows rows;  // the same

  /** @return false if they are not k */
  bool find(const std::vector<contact::Contact>& contacts, const std::vector<int>& members, const PatchScale& scale, int k,
            const ContactIds& ids) {
    if (static_cast<int>(ids.size()) != k) return false;
    const IdFilter filter(ids);
    places.clear();
    points.clear();
    rows.clear();
    for (int m = 0; m < static_cast<int>(members.size()); ++m) {
      const contact::Contact& contact = contacts[members[m]];
      if (!filter.has(contact.id)) continue;
      places.push_back(m);
      points.push_back(wrenchPoint(contact, scale));
      rows.add(points.back());
    }
    return static_cast<int>(places.size()) == k;
  }

  /** @param following of the points, the first that comes after this one */
  bool span(const WrenchPoint& point, std::size_t following) const {
    if (point.handicap > FARTHEST) return false;
    const WrenchPoint &next = points[following % points.size()], &last = points[(following + points.size() - 1) % points.size()];
    return addsLittleBetween(point, last, next) || addsLittleBeside(rows, point, MOST_LACK);
  }
};

}  // namespace

bool surelyGoesOn(const std::vector<contact::Contact>& contacts, const std::vector<int>& members, const PatchScale& scale, int k,
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
    } else if (!before.span(wrenchPoint(contacts[members[m]], scale), following)) {
      return false;
    }
  }
  return true;
}

}  // namespace blem_sim::reduction
