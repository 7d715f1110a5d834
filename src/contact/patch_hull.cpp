#include "patch_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace blem_sim {

namespace {

constexpr double FLATNESS = 1e-7;   // [m] a corner that stands out less is none: where vertices coincide, merging moves points about
constexpr double DEPTH_TIE = 1e-8;  // [m] a contact this much deeper than the interpolation adds nothing

// A contact seen along the normal.
struct PlanePoint {
  double x, y, depth;
  int contact;
};

// Total: at the same place the deepest comes first, then the first in canonical order.
bool planePointBefore(const PlanePoint& a, const PlanePoint& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  if (a.depth != b.depth) return a.depth > b.depth;
  return a.contact < b.contact;
}

double cross(const PlanePoint& o, const PlanePoint& a, const PlanePoint& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

double distance(const PlanePoint& a, const PlanePoint& b) { return std::hypot(b.x - a.x, b.y - a.y); }

// Drops points inside the octagon of extremes that are no deeper than any of its corners: convex combinations of those imply them. Saves
// most of the sorting of large patches.
void dropInner(std::vector<PlanePoint>& points) {
  constexpr std::size_t WORTHWHILE = 50;
  if (points.size() < WORTHWHILE) return;
  constexpr double DIRECTIONS[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  std::array<PlanePoint, 8> corners;
  for (int d = 0; d < 8; ++d) {
    const auto along = [&](const PlanePoint& p) { return DIRECTIONS[d][0] * p.x + DIRECTIONS[d][1] * p.y; };
    PlanePoint best = points[0];
    for (const PlanePoint& p : points) {
      if (along(p) > along(best) || (along(p) == along(best) && planePointBefore(p, best))) best = p;
    }
    corners[d] = best;
  }
  double shallowest = corners[0].depth;
  for (const PlanePoint& corner : corners) shallowest = std::min(shallowest, corner.depth);
  if (corners[0].contact == corners[4].contact) return;  // all at one place
  const auto isImplied = [&](const PlanePoint& p) {
    if (p.depth > shallowest + DEPTH_TIE) return false;
    for (int d = 0; d < 8; ++d) {
      const PlanePoint &from = corners[d], &to = corners[(d + 1) % 8];
      if (from.contact != to.contact && cross(from, to, p) <= FLATNESS * distance(from, to)) return false;
    }
    return true;
  };
  points.erase(std::remove_if(points.begin(), points.end(), isImplied), points.end());
}

std::vector<PlanePoint> projected(const std::vector<Contact>& contacts, const std::vector<int>& members, const Vector3& normal) {
  Eigen::Index smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  const Vector3 u = normal.cross(Vector3::Unit(smallest)).normalized();
  const Vector3 v = normal.cross(u);
  std::vector<PlanePoint> points;
  points.reserve(members.size());
  for (int member : members) {
    const Contact& contact = contacts[member];
    points.push_back({u.dot(contact.point), v.dot(contact.point), contact.depth, member});
  }
  dropInner(points);
  std::sort(points.begin(), points.end(), planePointBefore);
  const auto samePlace = [](const PlanePoint& a, const PlanePoint& b) {
    return std::abs(a.x - b.x) <= FLATNESS && std::abs(a.y - b.y) <= FLATNESS && b.depth <= a.depth + DEPTH_TIE;
  };
  points.erase(std::unique(points.begin(), points.end(), samePlace), points.end());
  return points;
}

// Half of the hull, from points.front() to points.back(), counter-clockwise for points sorted upwards. [Andrew 1979]
template <typename Iterator>
std::vector<PlanePoint> halfHull(Iterator begin, Iterator end) {
  std::vector<PlanePoint> half;
  for (Iterator p = begin; p != end; ++p) {
    while (half.size() >= 2 && cross(half[half.size() - 2], half.back(), *p) <= 0) half.pop_back();
    half.push_back(*p);
  }
  return half;
}

std::vector<PlanePoint> convexHull(const std::vector<PlanePoint>& sorted) {
  std::vector<PlanePoint> hull = halfHull(sorted.begin(), sorted.end());
  const std::vector<PlanePoint> upper = halfHull(sorted.rbegin(), sorted.rend());
  hull.pop_back();
  hull.insert(hull.end(), upper.begin(), upper.end() - 1);
  return hull;
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
void appendProminent(const std::vector<PlanePoint>& chain, std::size_t from, std::size_t to, std::vector<PlanePoint>& corners) {
  std::size_t farthest = from;
  double most = FLATNESS * distance(chain[from], chain[to]);
  for (std::size_t i = from + 1; i < to; ++i) {
    const double out = cross(chain[from], chain[i], chain[to]);
    if (out > most) {
      most = out;
      farthest = i;
    }
  }
  if (farthest == from) {
    corners.push_back(chain[from]);
    return;
  }
  appendProminent(chain, from, farthest, corners);
  appendProminent(chain, farthest, to, corners);
}

// The hull without corners that stand out less than FLATNESS: decided from the whole hull, since along a side noise decides what comes
// first in any order, and a chain thinned on the way can lose a true corner.
std::vector<PlanePoint> prominentCorners(const std::vector<PlanePoint>& hull) {
  if (hull.size() <= 2) return hull;
  const auto [first, second] = farthestPair(hull);
  std::vector<PlanePoint> ring(hull.begin() + first, hull.end());
  ring.insert(ring.end(), hull.begin(), hull.begin() + first + 1);
  std::vector<PlanePoint> corners;
  appendProminent(ring, 0, second - first, corners);
  appendProminent(ring, second - first, hull.size(), corners);
  return corners;
}

// Points that lie over one triangle of kept points (a segment if c is b).
struct Facet {
  PlanePoint a, b, c;
  std::vector<PlanePoint> points;
};

double interpolatedDepth(const Facet& facet, const PlanePoint& p) {
  const double area = cross(facet.a, facet.b, facet.c);
  if (area > 0) {
    const double weight_a = std::clamp(cross(facet.b, facet.c, p) / area, 0.0, 1.0);
    const double weight_b = std::clamp(cross(facet.c, facet.a, p) / area, 0.0, 1.0 - weight_a);
    return weight_a * facet.a.depth + weight_b * facet.b.depth + (1 - weight_a - weight_b) * facet.c.depth;
  }
  const double along = (p.x - facet.a.x) * (facet.b.x - facet.a.x) + (p.y - facet.a.y) * (facet.b.y - facet.a.y);
  const double length = distance(facet.a, facet.b);
  const double weight_b = length > 0 ? std::clamp(along / (length * length), 0.0, 1.0) : 0.0;
  return (1 - weight_b) * facet.a.depth + weight_b * facet.b.depth;
}

// How far p lies inside the facet's sides; negative outside.
double insideBy(const Facet& f, const PlanePoint& p) {
  const auto from_side = [&p](const PlanePoint& a, const PlanePoint& b) { return cross(a, b, p) / std::max(distance(a, b), 1e-300); };
  return std::min({from_side(f.a, f.b), from_side(f.b, f.c), from_side(f.c, f.a)});
}

// Hands each point of `from` to the facet that holds it, or misses it by least.
void distribute(const std::vector<PlanePoint>& from, std::vector<Facet>& facets) {
  for (const PlanePoint& p : from) {
    Facet* best = nullptr;
    double most = -std::numeric_limits<double>::infinity();
    for (Facet& facet : facets) {
      const double inside = insideBy(facet, p);
      if (best != nullptr && inside <= most) continue;
      best = &facet;
      most = inside;
      if (inside >= 0) break;
    }
    best->points.push_back(p);
  }
}

// The triangles of a fan around the first corner; a hull without area is one segment.
std::vector<Facet> fan(const std::vector<PlanePoint>& corners) {
  std::vector<Facet> facets;
  if (corners.size() <= 2) facets.push_back({corners.front(), corners.back(), corners.back(), {}});
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) facets.push_back({corners[0], corners[i], corners[i + 1], {}});
  return facets;
}

// The three triangles (two segments) into which p splits a facet; those without area are left out.
std::vector<Facet> split(const Facet& facet, const PlanePoint& p) {
  const bool is_segment = facet.b.contact == facet.c.contact;
  if (is_segment) return {{facet.a, p, p, {}}, {p, facet.b, facet.b, {}}};
  std::vector<Facet> facets;
  const std::array<std::pair<PlanePoint, PlanePoint>, 3> sides = {{{facet.a, facet.b}, {facet.b, facet.c}, {facet.c, facet.a}}};
  for (const auto& [from, to] : sides) {
    if (cross(from, to, p) > FLATNESS * distance(from, to)) facets.push_back({from, to, p, {}});
  }
  return facets;
}

// Under a segment, which half a point is in.
void distributeOnSegments(const Facet& parent, const PlanePoint& at, const std::vector<PlanePoint>& from, std::vector<Facet>& halves) {
  for (const PlanePoint& p : from) {
    const double dx = parent.b.x - parent.a.x, dy = parent.b.y - parent.a.y;
    const bool first = (p.x - at.x) * dx + (p.y - at.y) * dy < 0;
    halves[first ? 0 : 1].points.push_back(p);
  }
}

// Raises the interpolation over a facet to its highest point, again and again, until no point is above it.
void keepDeeper(Facet start, std::vector<int>& kept) {
  std::vector<Facet> open = {std::move(start)};
  while (!open.empty()) {
    const Facet facet = std::move(open.back());
    open.pop_back();
    const PlanePoint* highest = nullptr;
    double most = DEPTH_TIE;
    std::vector<PlanePoint> above;
    for (const PlanePoint& p : facet.points) {
      const double excess = p.depth - interpolatedDepth(facet, p);
      if (excess <= DEPTH_TIE) continue;
      above.push_back(p);
      if (highest != nullptr && (excess < most || (excess == most && p.contact > highest->contact))) continue;
      most = excess;
      highest = &p;
    }
    if (highest == nullptr) continue;
    const PlanePoint top = *highest;
    kept.push_back(top.contact);
    above.erase(std::remove_if(above.begin(), above.end(), [&](const PlanePoint& p) { return p.contact == top.contact; }), above.end());
    std::vector<Facet> pieces = split(facet, top);
    if (pieces.empty()) {
      // The point sits on a corner of a sliver: the rest can only be told apart by keeping it.
      for (const PlanePoint& p : above) kept.push_back(p.contact);
      continue;
    }
    if (facet.b.contact == facet.c.contact) {
      distributeOnSegments(facet, top, above, pieces);
    } else {
      distribute(above, pieces);
    }
    for (Facet& piece : pieces) open.push_back(std::move(piece));
  }
}

}  // namespace

std::vector<int> patchHull(const std::vector<Contact>& contacts, const std::vector<int>& members, const Vector3& normal) {
  const std::vector<PlanePoint> points = projected(contacts, members, normal);
  std::vector<int> kept;
  if (points.size() <= 2) {
    for (const PlanePoint& p : points) kept.push_back(p.contact);
  } else {
    const std::vector<PlanePoint> corners = prominentCorners(convexHull(points));
    for (const PlanePoint& corner : corners) kept.push_back(corner.contact);
    std::vector<int> sorted_corners = kept;
    std::sort(sorted_corners.begin(), sorted_corners.end());
    std::vector<PlanePoint> rest;
    for (const PlanePoint& p : points) {
      if (!std::binary_search(sorted_corners.begin(), sorted_corners.end(), p.contact)) rest.push_back(p);
    }
    std::vector<Facet> facets = fan(corners);
    if (corners.size() <= 2) {
      facets[0].points = std::move(rest);
    } else {
      distribute(rest, facets);
    }
    for (Facet& facet : facets) keepDeeper(std::move(facet), kept);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace blem_sim
