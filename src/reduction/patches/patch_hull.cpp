#include "patches/patch_hull.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "blem_sim/contact/contact_order.h"
#include "patches/patch_frame.h"

namespace blem_sim::reduction {

namespace {

constexpr int WORTHWHILE = 40;  // places: of fewer, none are sorted out before the hull

// Total: at the same place the deepest comes first, then the first in canonical order.
bool planePointBefore(const std::vector<contact::Contact>& contacts, const PlanePoint& a, const PlanePoint& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  if (a.depth != b.depth) return a.depth > b.depth;
  return a.contact != b.contact && contact::contactBefore(contacts[a.contact], contacts[b.contact]);
}

// Directions across which no mesh has sides.
const PlaneDirections& planeDirections() {
  static const PlaneDirections directions = [] {
    constexpr double FIRST = 0.1234;  // [rad]
    PlaneDirections made;
    for (int d = 0; d < OCTAGON_SIDES; ++d) {
      made.x[d] = std::cos(FIRST + 2 * M_PI * d / OCTAGON_SIDES);
      made.y[d] = std::sin(FIRST + 2 * M_PI * d / OCTAGON_SIDES);
    }
    return made;
  }();
  return directions;
}

// Places of the members in the plane, and their depths.
void project(const std::vector<contact::Contact>& contacts, const int* begin, const int* end, const Vector3& normal, PlanePlaces* places) {
  const PlaneAxes axes = axesAcross(normal);
  places->x.resize(end - begin);
  places->y.resize(end - begin);
  places->depth.resize(end - begin);
  for (std::size_t i = 0; i < places->x.size(); ++i) {
    const contact::Contact& contact = contacts[begin[i]];
    places->x[i] = axes.u.dot(contact.point);
    places->y[i] = axes.v.dot(contact.point);
    places->depth[i] = contact.depth;
  }
}

// Finds the places that are farthest out along the octagon's directions.
void findExtremes(PatchHullRoom* room) {
  const PlanePlaces& places = room->places;
  room->farthest.resize(places.x.size());
  room->farthest.resize(findFarthest(planeDirections(), places, &room->extremes, room->farthest.data()));
}

// The first place that is farthest along a direction.
int farthestAlong(int direction, const PatchHullRoom& room) {
  const PlanePlaces& places = room.places;
  return *std::find_if(room.farthest.begin(), room.farthest.end(), [&](int i) {
    return planeDirections().along(direction, places.x[i], places.y[i]) == room.extremes.value[direction];
  });
}

// Indices of the places that may be corners: others lie inside the octagon of extremes. This saves most of the sorting of large patches.
void findOuter(PatchHullRoom* room) {
  const std::vector<double>&x = room->places.x, &y = room->places.y;
  const int count = static_cast<int>(x.size());
  std::vector<int>& outside = room->outside;
  outside.resize(count);
  std::iota(outside.begin(), outside.end(), 0);
  if (count < WORTHWHILE) return;
  findExtremes(room);
  int corners[OCTAGON_SIDES];
  for (int d = 0; d < OCTAGON_SIDES; ++d) corners[d] = farthestAlong(d, *room);
  Octagon octagon;
  int sides = 0;
  for (int d = 0; d < OCTAGON_SIDES; ++d) {
    const int from = corners[d], to = corners[(d + 1) % OCTAGON_SIDES];
    octagon.x[d] = x[from];
    octagon.y[d] = y[from];
    octagon.dx[d] = x[to] - x[from];
    octagon.dy[d] = y[to] - y[from];
    octagon.limit[d] = from == to ? -1 : FLATNESS * std::sqrt(octagon.dx[d] * octagon.dx[d] + octagon.dy[d] * octagon.dy[d]);
    sides += from != to;
  }
  if (sides < 3) return;  // all at one place, or in a line
  outside.resize(findOutside(octagon, room->places, outside.data()));
}

// The outer places as points, sorted, of those at one place the deepest.
void sortOuter(const std::vector<contact::Contact>& contacts, const int* members, PatchHullRoom* room) {
  const PlanePlaces& places = room->places;
  std::vector<PlanePoint>& points = room->points;
  points.clear();
  for (const int i : room->outside) points.push_back({places.x[i], places.y[i], places.depth[i], members[i]});
  std::sort(points.begin(), points.end(), [&](const PlanePoint& a, const PlanePoint& b) { return planePointBefore(contacts, a, b); });
  const auto samePlace = [](const PlanePoint& a, const PlanePoint& b) {
    return std::abs(a.x - b.x) <= FLATNESS && std::abs(a.y - b.y) <= FLATNESS && b.depth <= a.depth + DEPTH_TIE;
  };
  points.erase(std::unique(points.begin(), points.end(), samePlace), points.end());
}

// Half of the hull, from points.front() to points.back(), counter-clockwise for points sorted upwards. [Andrew 1979]
template <typename Iterator>
void halfHull(Iterator begin, Iterator end, std::vector<PlanePoint>* half) {
  half->clear();
  for (Iterator p = begin; p != end; ++p) {
    while (half->size() >= 2 && cross((*half)[half->size() - 2], half->back(), *p) <= 0) half->pop_back();
    half->push_back(*p);
  }
}

void convexHull(PatchHullRoom* room) {
  halfHull(room->points.begin(), room->points.end(), &room->hull);
  halfHull(room->points.rbegin(), room->points.rend(), &room->half);
  room->hull.pop_back();
  room->hull.insert(room->hull.end(), room->half.begin(), room->half.end() - 1);
}

std::size_t farthestFrom(const std::vector<PlanePoint>& hull, std::size_t from) {
  std::size_t farthest = from;
  double most = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const double dx = hull[i].x - hull[from].x, dy = hull[i].y - hull[from].y, length2 = dx * dx + dy * dy;
    if (length2 <= most) continue;
    most = length2;
    farthest = i;
  }
  return farthest;
}

// Two corners, ascending, each the farthest from the other: they stand out whatever lies along the sides.
std::pair<std::size_t, std::size_t> farthestPair(const std::vector<PlanePoint>& hull) {
  std::size_t one = farthestFrom(hull, 0), other = farthestFrom(hull, one);
  for (;;) {
    const std::size_t next = farthestFrom(hull, other);
    if (distance(hull[other], hull[next]) <= distance(hull[other], hull[one])) break;
    one = std::exchange(other, next);
  }
  return {std::min(one, other), std::max(one, other)};
}

// Appends chain[from] and those of the corners up to, and without, chain[to] that stand out from the chords. [Douglas 1973]
void appendProminent(const std::vector<PlanePoint>& chain, std::size_t from, std::size_t to, std::vector<PlanePoint>* corners) {
  if (to == from + 1) return corners->push_back(chain[from]);
  std::size_t farthest = from;
  double most = FLATNESS * distance(chain[from], chain[to]);
  for (std::size_t i = from + 1; i < to; ++i) {
    const double out = cross(chain[from], chain[i], chain[to]);
    if (out > most) {
      most = out;
      farthest = i;
    }
  }
  if (farthest == from) return corners->push_back(chain[from]);
  appendProminent(chain, from, farthest, corners);
  appendProminent(chain, farthest, to, corners);
}

// The hull without corners that stand out less than FLATNESS: decided from the whole hull, since along a side noise decides what comes
// first in any order, and a chain thinned on the way can lose a true corner.
void findCorners(PatchHullRoom* room) {
  room->corners = room->points;
  if (room->points.size() <= 2) return;
  convexHull(room);
  const std::vector<PlanePoint>& hull = room->hull;
  room->corners = hull;
  if (hull.size() <= 2) return;
  const auto [first, second] = farthestPair(hull);
  room->ring.assign(hull.begin() + first, hull.end());
  room->ring.insert(room->ring.end(), hull.begin(), hull.begin() + first + 1);
  room->corners.clear();
  appendProminent(room->ring, 0, second - first, &room->corners);
  appendProminent(room->ring, second - first, hull.size(), &room->corners);
}

}  // namespace

void patchHull(const PatchMembers& members, const Vector3& normal, PatchHullRoom* room, std::vector<int>* kept) {
  const auto& [contacts, begin, end] = members;
  if (end - begin == 1) return kept->push_back(*begin);
  project(contacts, begin, end, normal, &room->places);
  findOuter(room);
  sortOuter(contacts, begin, room);
  findCorners(room);
  for (const PlanePoint& corner : room->corners) kept->push_back(corner.contact);
  if (room->corners.size() == room->places.x.size()) return;  // no other
  room->depths.keepDeeper(contacts, begin, room->places, room->corners, kept);
}

}  // namespace blem_sim::reduction
