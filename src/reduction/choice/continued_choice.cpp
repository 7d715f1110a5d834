#include "choice/continued_choice.h"

#include <algorithm>
#include <limits>

#include "choice/id_filter.h"

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

/** @return false if they are not k */
bool findChosenBefore(const ChoiceQuestion& asked, ChosenBefore* before) {
  if (static_cast<int>(asked.chosen_before.size()) != asked.k) return false;
  const IdFilter filter(asked.chosen_before);
  before->places.clear();
  before->points.clear();
  before->rows.clear();
  for (int m = 0; m < static_cast<int>(asked.members.size()); ++m) {
    const contact::Contact& contact = asked.contacts[asked.members[m]];
    if (!filter.has(contact.id)) continue;
    before->places.push_back(m);
    before->points.push_back(wrenchPoint(contact, asked.scale));
    before->rows.add(before->points.back());
  }
  return static_cast<int>(before->places.size()) == asked.k;
}

/** @param following of the points, the first that comes after this one */
bool isSpanned(const ChosenBefore& before, const WrenchPoint& point, std::size_t following) {
  if (point.handicap > FARTHEST) return false;
  const std::vector<WrenchPoint>& points = before.points;
  const WrenchPoint &next = points[following % points.size()], &last = points[(following + points.size() - 1) % points.size()];
  return addsLittleBetween(point, last, next) || addsLittleBeside(before.rows, point, MOST_LACK);
}

}  // namespace

bool surelyGoesOn(const ChoiceQuestion& asked, ChosenBefore* before, std::vector<int>* chosen) {
  if (!findChosenBefore(asked, before)) return false;
  const std::vector<contact::Contact>& contacts = asked.contacts;
  const std::vector<int>& members = asked.members;
  const PatchScale& scale = asked.scale;
  double depth = -std::numeric_limits<double>::infinity();
  chosen->clear();
  for (const int place : before->places) {
    chosen->push_back(members[place]);
    depth = std::max(depth, contacts[members[place]].depth);
  }
  if (depth < scale.depth() - DEEP_ENOUGH) return false;
  std::size_t following = 0;  // the first of those chosen before that comes after the member
  for (int m = 0; m < static_cast<int>(members.size()); ++m) {
    if (following < before->places.size() && before->places[following] == m) {
      ++following;
    } else if (!isSpanned(*before, wrenchPoint(contacts[members[m]], scale), following)) {
      return false;
    }
  }
  return true;
}

}  // namespace blem_sim::reduction
