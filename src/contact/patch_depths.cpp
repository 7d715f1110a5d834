#include "patch_depths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact_order.h"

namespace blem_sim {

double PatchDepths::interpolatedDepth(const Facet& facet, const PlanePoint& p) {
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

PatchDepths::Facet::Facet(const PlanePoint& first_corner, const PlanePoint& second_corner, const PlanePoint& third_corner)
    : a(first_corner), b(second_corner), c(third_corner) {
  const PlanePoint* const corners[4] = {&a, &b, &c, &a};
  for (int side = 0; side < 3; ++side) {
    const double length = std::max(distance(*corners[side], *corners[side + 1]), 1e-300);
    side_x[side] = (corners[side + 1]->x - corners[side]->x) / length;
    side_y[side] = (corners[side + 1]->y - corners[side]->y) / length;
  }
}

double PatchDepths::Facet::insideBy(const PlanePoint& p) const {
  const auto from_side = [&](const PlanePoint& corner, int side) {
    return side_x[side] * (p.y - corner.y) - side_y[side] * (p.x - corner.x);
  };
  return std::min({from_side(a, 0), from_side(b, 1), from_side(c, 2)});
}

void PatchDepths::hand(int point, Facet* facet) {
  (*points_)[point].next = facet->first;
  facet->first = point;
}

// Hands each point of a list to the facet, of the last ones, that holds it, or misses it by least.
void PatchDepths::distribute(int first, std::size_t first_facet) {
  for (int point = first; point != NO_POINT;) {
    const PlanePoint p = (*points_)[point];
    std::size_t best = first_facet;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t facet = first_facet; facet < open_.size() && most < 0; ++facet) {
      const double inside = open_[facet].insideBy(p);
      if (inside <= most) continue;
      best = facet;
      most = inside;
    }
    hand(point, &open_[best]);
    point = p.next;
  }
}

// On a segment: which half a point is in.
void PatchDepths::distributeOnSegments(const Facet& parent, const PlanePoint& at, int first, std::size_t first_facet) {
  const double dx = parent.b.x - parent.a.x, dy = parent.b.y - parent.a.y;
  for (int point = first; point != NO_POINT;) {
    const PlanePoint p = (*points_)[point];
    const bool before = (p.x - at.x) * dx + (p.y - at.y) * dy < 0;
    hand(point, &open_[first_facet + (before ? 0 : 1)]);
    point = p.next;
  }
}

// Opens the three triangles (two segments) into which p splits a facet; those without area are left out.
void PatchDepths::split(const Facet& facet, const PlanePoint& p) {
  if (facet.isSegment()) {
    open_.emplace_back(facet.a, p, p);
    open_.emplace_back(p, facet.b, facet.b);
    return;
  }
  const PlanePoint corners[4] = {facet.a, facet.b, facet.c, facet.a};
  for (int side = 0; side < 3; ++side) {
    const PlanePoint &from = corners[side], &to = corners[side + 1];
    if (cross(from, to, p) > FLATNESS * distance(from, to)) open_.emplace_back(from, to, p);
  }
}

int PatchDepths::highest(const std::vector<Contact>& contacts, Facet* facet) {
  int best = NO_POINT, above = NO_POINT;
  double most = DEPTH_TIE;
  for (int point = facet->first; point != NO_POINT;) {
    PlanePoint& p = (*points_)[point];
    const int next = p.next;
    const double excess = p.depth - interpolatedDepth(*facet, p);
    if (excess > DEPTH_TIE) {
      p.next = above;
      above = point;
      const bool higher =
          best == NO_POINT || excess > most || (excess == most && contactBefore(contacts[p.contact], contacts[(*points_)[best].contact]));
      if (higher) {
        most = excess;
        best = point;
      }
    }
    point = next;
  }
  facet->first = above;
  return best;
}

void PatchDepths::keepDeeper(const std::vector<Contact>& contacts, const std::vector<PlanePoint>& corners, std::vector<PlanePoint>* points,
                             std::vector<int>* kept) {
  points_ = points;
  // The triangles of a fan around the first corner; a hull without area is one segment.
  open_.clear();
  if (corners.size() <= 2) open_.emplace_back(corners.front(), corners.back(), corners.back());
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) open_.emplace_back(corners[0], corners[i], corners[i + 1]);
  double shallowest = corners[0].depth;
  corner_contacts_.clear();
  for (const PlanePoint& corner : corners) {
    shallowest = std::min(shallowest, corner.depth);
    corner_contacts_.push_back(corner.contact);
  }
  std::sort(corner_contacts_.begin(), corner_contacts_.end());
  int rest = NO_POINT;
  for (std::size_t i = 0; i < points->size(); ++i) {
    PlanePoint& p = (*points)[i];
    const bool is_corner = std::binary_search(corner_contacts_.begin(), corner_contacts_.end(), p.contact);
    if (p.depth <= shallowest + DEPTH_TIE || is_corner) continue;
    p.next = rest;
    rest = static_cast<int>(i);
  }
  distribute(rest, 0);

  while (!open_.empty()) {
    Facet facet = open_.back();
    open_.pop_back();
    const int top = highest(contacts, &facet);
    if (top == NO_POINT) continue;
    const PlanePoint p = (*points)[top];
    kept->push_back(p.contact);
    // The rest of the list, without the top.
    int above = NO_POINT;
    for (int point = facet.first; point != NO_POINT;) {
      const int next = (*points)[point].next;
      if (point != top) {
        (*points)[point].next = above;
        above = point;
      }
      point = next;
    }
    const std::size_t pieces = open_.size();
    split(facet, p);
    if (open_.size() == pieces) {
      // The point sits on a corner of a sliver: the rest can only be told apart by keeping it.
      for (int point = above; point != NO_POINT; point = (*points)[point].next) kept->push_back((*points)[point].contact);
    } else if (facet.isSegment()) {
      distributeOnSegments(facet, p, above, pieces);
    } else {
      distribute(above, pieces);
    }
  }
}

}  // namespace blem_sim
