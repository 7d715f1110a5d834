#include "guard/layer_watch.h"

#include <algorithm>
#include <cstddef>

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim::sim {
namespace {

/** @param manifold one of those found */
LayerEventReport eventOf(const FoundContacts& found, const contact::ContactManifold& manifold, double time) {
  LayerEventReport event;
  event.time = time;
  event.collider_a = manifold.a;
  event.collider_b = manifold.b;
  event.depth = std::max(0.0, found.depthOf(manifold));
  event.of_layer = manifold.layer > 0 ? event.depth / manifold.layer : 0;
  event.pierced = manifold.pierced;
  event.outside = event.of_layer > 1 || event.pierced;
  return event;
}

LayerEventReport goneEvent(const std::pair<int, int>& pair, double time) {
  LayerEventReport event;
  event.time = time;
  event.collider_a = pair.first;
  event.collider_b = pair.second;
  return event;
}

/** @param found contacts before the pair passed */
LayerEventReport passEvent(const std::pair<int, int>& pair, const FoundContacts& found, double time) {
  const contact::ContactManifold* manifold = contact::findPair(found.manifolds, pair.first, pair.second);
  LayerEventReport event = manifold ? eventOf(found, *manifold, time) : goneEvent(pair, time);
  event.outside = event.pierced = true;
  return event;
}

}  // namespace

void LayerWatch::look(const FoundContacts& found, const std::vector<std::pair<int, int>>& passed, double time,
                      std::vector<LayerEventReport>* events) {
  const std::size_t first = events->size();
  next_outside_.clear();
  auto known = outside_.begin();
  // Both are sorted: pairs that were outside and have no contacts any more come before the next manifold.
  const auto tellGoneBefore = [&](const std::pair<int, int>* pair) {
    for (; known != outside_.end() && (pair == nullptr || *known < *pair); ++known) events->push_back(goneEvent(*known, time));
  };
  for (const contact::ContactManifold& manifold : found.manifolds) {
    const std::pair<int, int> pair(manifold.a, manifold.b);
    tellGoneBefore(&pair);
    const bool was_outside = known != outside_.end() && *known == pair;
    if (was_outside) ++known;
    const LayerEventReport event = eventOf(found, manifold, time);
    if (event.outside) next_outside_.push_back(pair);
    if (event.outside != was_outside) events->push_back(event);
  }
  tellGoneBefore(nullptr);
  std::swap(outside_, next_outside_);
  if (!passed.empty()) addPassed(found, passed, time, first, events);
}

/** @param first of the events of this look */
void LayerWatch::addPassed(const FoundContacts& found, const std::vector<std::pair<int, int>>& passed, double time, std::size_t first,
                           std::vector<LayerEventReport>* events) {
  for (const std::pair<int, int>& pair : passed) {
    const auto at = std::lower_bound(outside_.begin(), outside_.end(), pair);
    if (at != outside_.end() && *at == pair) continue;
    outside_.insert(at, pair);
    events->push_back(passEvent(pair, found, time));
  }
  std::stable_sort(events->begin() + static_cast<std::ptrdiff_t>(first), events->end(), [](const auto& p, const auto& q) {
    return std::make_pair(p.collider_a, p.collider_b) < std::make_pair(q.collider_a, q.collider_b);
  });
}

void LayerWatch::save(geometry::StateWriter* writer) const {
  writer->word(outside_.size());
  for (const auto& [a, b] : outside_) {
    writer->integer(a);
    writer->integer(b);
  }
}

void LayerWatch::forget(int collider) {
  const auto has_it = [&](const std::pair<int, int>& pair) { return pair.first == collider || pair.second == collider; };
  outside_.erase(std::remove_if(outside_.begin(), outside_.end(), has_it), outside_.end());
}

void LayerWatch::restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader) {
  outside_.clear();
  for (std::size_t left = reader->count(2, 0); left > 0; --left) {
    // A collider that was just taken out is still to be told gone.
    const std::pair<int, int> pair = contact::readSlots(colliders, reader);
    if (!outside_.empty() && pair <= outside_.back()) contact::refusePairs(*reader);
    outside_.push_back(pair);
  }
}

}  // namespace blem_sim::sim
