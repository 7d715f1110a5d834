#include "contacts/search/flush_surfaces.h"

#include <algorithm>

namespace blem_sim::sim {
namespace {

constexpr double SAME_WIDTH = 1e-6;  // [m] parts that a layer thinner by more leaves uncovered stand out

/** A cloud of points has no surface that another could go on with. */
bool hasSurface(const contact::Collider& collider) { return collider.geometry->isHalfSpace() || !collider.geometry->mesh().isPoint(0); }

}  // namespace

void FlushSurfaces::watch(const std::vector<contact::Collider>& colliders, const std::vector<WatchedPair>& pairs,
                          const FadingPoints& fading) {
  neighbours_.clear();
  for (const WatchedPair& pair : pairs) {
    const bool a_is_fixed = colliders[pair.a].body == dynamics::WORLD_BODY;
    const int fixed = a_is_fixed ? pair.a : pair.b, moving = a_is_fixed ? pair.b : pair.a;
    // Surfaces that fade carry less than their places say, and must not take over.
    if (colliders[fixed].body == dynamics::WORLD_BODY && hasSurface(colliders[fixed]) && !fading.fades(fixed))
      neighbours_.push_back({moving, fixed});
  }
  std::sort(neighbours_.begin(), neighbours_.end(),
            [](const Neighbour& a, const Neighbour& b) { return a.moving != b.moving ? a.moving < b.moving : a.fixed < b.fixed; });
  std::size_t kept = 0;
  for (std::size_t first = 0, end = 0; first < neighbours_.size(); first = end) {
    while (end < neighbours_.size() && neighbours_[end].moving == neighbours_[first].moving) ++end;
    if (end - first < 2) continue;
    for (std::size_t i = first; i < end; ++i) neighbours_[kept++] = neighbours_[i];
  }
  neighbours_.resize(kept);
}

void FlushSurfaces::dropCovered(const std::vector<contact::Collider>& colliders, const std::vector<contact::ColliderMotion>& motion,
                                contact::SurfaceCover* cover, contact::ContactManifold* manifold) const {
  const bool a_is_fixed = colliders[manifold->a].body == dynamics::WORLD_BODY;
  if (neighbours_.empty() || manifold->pierced || (!a_is_fixed && colliders[manifold->b].body != dynamics::WORLD_BODY)) return;
  const int moving = a_is_fixed ? manifold->b : manifold->a, fixed = a_is_fixed ? manifold->a : manifold->b;
  const auto [first, end] = std::equal_range(neighbours_.begin(), neighbours_.end(), Neighbour{moving, fixed},
                                             [](const Neighbour& a, const Neighbour& b) { return a.moving < b.moving; });
  if (first == end) return;
  const double thinnest = colliders[fixed].radius - SAME_WIDTH;
  const auto isCovered = [&, first = first, end = end](const contact::Contact& contact) {
    cover->begin(contact, a_is_fixed, colliders[fixed], motion[fixed].X_WC);
    for (auto other = first; other != end; ++other)
      if (other->fixed != fixed && colliders[other->fixed].radius >= thinnest)
        cover->add(colliders[other->fixed], motion[other->fixed].X_WC, other->fixed < fixed);
    return cover->isCovered();
  };
  std::vector<contact::Contact>& contacts = manifold->contacts;
  contacts.erase(std::remove_if(contacts.begin(), contacts.end(), isCovered), contacts.end());
}

}  // namespace blem_sim::sim
