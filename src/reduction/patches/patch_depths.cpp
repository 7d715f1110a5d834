#include "patches/patch_depths.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/contact/contact_order.h"

namespace blem_sim::reduction {

int PatchDepths::deepestPlace() const {
  const std::vector<double>& depth = places_->depth;
  int best = 0;
  for (int i = 1; i < static_cast<int>(depth.size()); ++i) {
    if (depth[i] < depth[best]) continue;
    if (depth[i] > depth[best] || contact::contactBefore((*contacts_)[members_[i]], (*contacts_)[members_[best]])) best = i;
  }
  return best;
}

void PatchDepths::openFan(const std::vector<PlanePoint>& corners, const PlanePoint& deepest, std::vector<int>* kept) {
  const auto deepest_corner =
      std::max_element(corners.begin(), corners.end(), [](const PlanePoint& p, const PlanePoint& q) { return p.depth < q.depth; });
  bool around_deepest = deepest.depth > deepest_corner->depth + DEPTH_TIE;
  for (std::size_t i = 0; i < corners.size() && around_deepest; ++i) {
    const PlanePoint &from = corners[i], &to = corners[(i + 1) % corners.size()];
    around_deepest = cross(from, to, deepest) > FLATNESS * distance(from, to);
  }
  const PlanePoint& middle = around_deepest ? deepest : *deepest_corner;
  if (around_deepest) kept->push_back(deepest.contact);
  ring_.assign(deepest_corner + 1, corners.end());
  ring_.insert(ring_.end(), corners.begin(), deepest_corner);
  if (around_deepest) ring_.insert(ring_.end(), {*deepest_corner, ring_.front()});
  for (std::size_t i = 0; i + 1 < ring_.size(); ++i) open_.emplace_back(middle, ring_[i], ring_[i + 1]);
  fan_.start(middle.x, middle.y, around_deepest);
  for (std::size_t i = 0; i + 1 < ring_.size(); ++i) fan_.addSide(ring_[i].x, ring_[i].y);
}

void PatchDepths::handToFan(double shallowest) {
  const int count = static_cast<int>(places_->x.size());
  sectors_.resize(count);
  findSectors(fan_, places_->x.data(), places_->y.data(), count, sectors_.data());
  for (int i = 0; i < count; ++i) {
    if (places_->depth[i] > shallowest + DEPTH_TIE) hand(i, pointAt(i), &open_[sectors_[i]]);
  }
}

void PatchDepths::hand(int place, const PlanePoint& point, Facet* facet) {
  const double excess = point.depth - facet->depthAt(point);
  if (excess <= DEPTH_TIE) return;
  next_[place] = facet->first;
  facet->first = place;
  const bool higher = excess > facet->most || (excess == facet->most &&
                                               contact::contactBefore((*contacts_)[point.contact], (*contacts_)[members_[facet->highest]]));
  if (!higher) return;
  facet->highest = place;
  facet->most = excess;
}

void PatchDepths::raise(const Facet& facet, std::vector<int>* kept) {
  const PlanePoint top = pointAt(facet.highest);
  kept->push_back(top.contact);
  if (!facet.isSegment()) return raiseTriangle(facet, top, kept);
  const std::size_t half = open_.size();
  open_.emplace_back(facet.a, top, top);
  open_.emplace_back(top, facet.b, facet.b);
  const double dx = facet.b.x - facet.a.x, dy = facet.b.y - facet.a.y;
  for (int place = facet.first, next; place != NO_PLACE; place = next) {
    next = next_[place];
    const PlanePoint p = pointAt(place);
    if (place != facet.highest) hand(place, p, &open_[half + ((p.x - top.x) * dx + (p.y - top.y) * dy < 0 ? 0 : 1)]);
  }
}

void PatchDepths::raiseTriangle(const Facet& facet, const PlanePoint& top, std::vector<int>* kept) {
  // Pieces opposite to c, a, b; those without area are left out, and their places belong to the neighbour on their side of the spoke.
  const PlanePoint corners[4] = {facet.a, facet.b, facet.c, facet.a};
  int pieces[3] = {NO_PLACE, NO_PLACE, NO_PLACE}, last = NO_PLACE;
  for (int side = 0; side < 3; ++side) {
    const PlanePoint &from = corners[side], &to = corners[side + 1];
    if (cross(from, to, top) <= FLATNESS * distance(from, to)) continue;
    pieces[side] = last = static_cast<int>(open_.size());
    open_.emplace_back(from, to, top);
  }
  for (int place = facet.first, next; place != NO_PLACE; place = next) {
    next = next_[place];
    if (place == facet.highest) continue;
    const PlanePoint p = pointAt(place);
    // On the top of a sliver's corner: places can only be told apart by keeping them.
    if (last == NO_PLACE) {
      kept->push_back(p.contact);
      continue;
    }
    const bool left[3] = {cross(top, corners[0], p) >= 0, cross(top, corners[1], p) >= 0, cross(top, corners[2], p) >= 0};
    const int side = left[0] && !left[1] ? 0 : (left[1] && !left[2] ? 1 : 2);
    int piece = pieces[side];
    if (piece == NO_PLACE) piece = pieces[left[(side + 2) % 3] ? (side + 2) % 3 : (side + 1) % 3];
    hand(place, p, &open_[piece == NO_PLACE ? last : piece]);
  }
}

void PatchDepths::keepDeeper(const std::vector<contact::Contact>& contacts, const int* members, const PlanePlaces& places,
                             const std::vector<PlanePoint>& corners, std::vector<int>* kept) {
  contacts_ = &contacts;
  members_ = members;
  places_ = &places;
  const auto shallowest =
      std::min_element(corners.begin(), corners.end(), [](const PlanePoint& p, const PlanePoint& q) { return p.depth < q.depth; });
  const PlanePoint deepest = pointAt(deepestPlace());
  if (deepest.depth <= shallowest->depth + DEPTH_TIE) return;
  next_.resize(places.x.size());
  open_.clear();
  if (corners.size() > 2) {
    openFan(corners, deepest, kept);
    handToFan(shallowest->depth);
  } else {
    open_.emplace_back(corners.front(), corners.back(), corners.back());
    for (int i = 0; i < static_cast<int>(places.x.size()); ++i) hand(i, pointAt(i), &open_.front());
  }
  while (!open_.empty()) {
    const Facet facet = open_.back();
    open_.pop_back();
    if (facet.highest != NO_PLACE) raise(facet, kept);
  }
}

}  // namespace blem_sim::reduction
