#include "patch_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact_order.h"
#include "patch_depths.h"
#include "patch_frame.h"
#include "reduction_lanes.h"

namespace blem_sim {

namespace {

struct Buffers {
  std::vector<PlanePlace> places;
  std::vector<int> outside;
  std::vector<PlanePoint> points, half, hull, ring, corners;
  PatchDepths depths;
};

// Total: at the same place the deepest comes first, then the first in canonical order.
bool planePointBefore(const std::vector<Contact>& contacts, const PlanePoint& a, const PlanePoint& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  if (a.depth != b.depth) return a.depth > b.depth;
  return a.contact != b.contact && contactBefore(contacts[a.contact], contacts[b.contact]);
}

PlanePoint pointOf(const PlanePlace& place, int contact) { return {place.x, place.y, place.depth, contact, NO_POINT}; }

// The extremes of the places in eight directions, counter-clockwise.
std::array<PlanePoint, OCTAGON_SIDES> octagonOf(const std::vector<Contact>& contacts, const std::vector<PlanePlace>& places,
                                                const int* members) {
  std::array<PlanePoint, OCTAGON_SIDES> corners;
  double most[OCTAGON_SIDES];
  std::fill(std::begin(most), std::end(most), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double x = places[i].x, y = places[i].y;
    const double along[OCTAGON_SIDES] = {x, x + y, y, y - x, -x, -x - y, -y, x - y};
    int reached = 0;
    for (int d = 0; d < OCTAGON_SIDES; ++d) reached |= along[d] >= most[d];
    if (!reached) continue;
    const PlanePoint point = pointOf(places[i], members[i]);
    for (int d = 0; d < OCTAGON_SIDES; ++d) {
      if (along[d] < most[d] || (along[d] == most[d] && !planePointBefore(contacts, point, corners[d]))) continue;
      corners[d] = point;
      most[d] = along[d];
    }
  }
  return corners;
}

// Indices of the places to look at: others lie inside the octagon of extremes and are no deeper than any of its corners, so convex
// combinations of those imply them. Saves most of the sorting of large patches.
void findOuter(const std::vector<Contact>& contacts, const int* members, Buffers* buffers) {
  constexpr std::size_t WORTHWHILE = 50;
  const std::vector<PlanePlace>& places = buffers->places;
  std::vector<int>& outside = buffers->outside;
  outside.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) outside[i] = static_cast<int>(i);
  if (places.size() < WORTHWHILE) return;
  const std::array<PlanePoint, OCTAGON_SIDES> corners = octagonOf(contacts, places, members);
  if (corners[0].contact == corners[4].contact) return;  // all at one place
  double shallowest = corners[0].depth;
  Octagon octagon;
  for (int d = 0; d < OCTAGON_SIDES; ++d) {
    const PlanePoint &from = corners[d], &to = corners[(d + 1) % OCTAGON_SIDES];
    shallowest = std::min(shallowest, from.depth);
    octagon.x[d] = from.x;
    octagon.y[d] = from.y;
    octagon.dx[d] = to.x - from.x;
    octagon.dy[d] = to.y - from.y;
    octagon.limit[d] = from.contact == to.contact ? -1 : FLATNESS * distance(from, to);
  }
  outside.resize(findOutside(octagon, shallowest + DEPTH_TIE, places.data(), static_cast<int>(places.size()), outside.data()));
}

// The points of the members in the plane, sorted, of those at one place the deepest.
void project(const std::vector<Contact>& contacts, const int* begin, const int* end, const Vector3& normal, Buffers* buffers) {
  const PlaneAxes axes = axesAcross(normal);
  buffers->places.resize(end - begin);
  for (const int* member = begin; member != end; ++member) {
    const Contact& contact = contacts[*member];
    buffers->places[member - begin] = {axes.u.dot(contact.point), axes.v.dot(contact.point), contact.depth};
  }
  findOuter(contacts, begin, buffers);
  std::vector<PlanePoint>& points = buffers->points;
  points.clear();
  for (const int i : buffers->outside) points.push_back(pointOf(buffers->places[i], begin[i]));
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

void convexHull(Buffers* buffers) {
  halfHull(buffers->points.begin(), buffers->points.end(), &buffers->hull);
  halfHull(buffers->points.rbegin(), buffers->points.rend(), &buffers->half);
  buffers->hull.pop_back();
  buffers->hull.insert(buffers->hull.end(), buffers->half.begin(), buffers->half.end() - 1);
}

// The two corners farthest from each other, ascending: they stand out whatever lies along the sides.
std::pair<std::size_t, std::size_t> farthestPair(const std::vector<PlanePoint>& hull) {
  std::pair<std::size_t, std::size_t> farthest = {0, 0};
  double most = -1;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    for (std::size_t j = i + 1; j < hull.size(); ++j) {
      const double dx = hull[j].x - hull[i].x, dy = hull[j].y - hull[i].y, length2 = dx * dx + dy * dy;
      if (length2 > most) {
        most = length2;
        farthest = {i, j};
      }
    }
  }
  return farthest;
}

// Appends chain[from] and those of the corners up to, and without, chain[to] that stand out from the chords. [Douglas 1973]
void appendProminent(const std::vector<PlanePoint>& chain, std::size_t from, std::size_t to, std::vector<PlanePoint>* corners) {
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
void findCorners(Buffers* buffers) {
  convexHull(buffers);
  const std::vector<PlanePoint>& hull = buffers->hull;
  buffers->corners = hull;
  if (hull.size() <= 2) return;
  const auto [first, second] = farthestPair(hull);
  buffers->ring.assign(hull.begin() + first, hull.end());
  buffers->ring.insert(buffers->ring.end(), hull.begin(), hull.begin() + first + 1);
  buffers->corners.clear();
  appendProminent(buffers->ring, 0, second - first, &buffers->corners);
  appendProminent(buffers->ring, second - first, hull.size(), &buffers->corners);
}

}  // namespace

void patchHull(const std::vector<Contact>& contacts, const int* begin, const int* end, const Vector3& normal, std::vector<int>* kept) {
  static thread_local Buffers buffers;
  if (end - begin == 1) return kept->push_back(*begin);
  project(contacts, begin, end, normal, &buffers);
  if (buffers.points.size() <= 2) {
    for (const PlanePoint& p : buffers.points) kept->push_back(p.contact);
    return;
  }
  findCorners(&buffers);
  for (const PlanePoint& corner : buffers.corners) kept->push_back(corner.contact);
  buffers.depths.keepDeeper(contacts, buffers.corners, &buffers.points, kept);
}

}  // namespace blem_sim
