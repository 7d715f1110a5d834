#include "contacts/constraints/layer_stops.h"

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim::sim {

const std::vector<contact::Contact>& LayerStops::choose(const contact::ContactManifold& manifold, const reduction::Reduction& method,
                                                        reduction::ReductionWorkspace* workspace) {
  static const std::vector<contact::Contact> none;
  deep_.clear();
  for (const contact::Contact& contact : manifold.contacts) {
    if (!(contact.depth > SEEN * manifold.layer)) continue;
    deep_.push_back(contact);
    deep_.back().depth -= STOP * manifold.layer;
  }
  if (deep_.empty()) return none;
  if (count_ == stops_.size()) stops_.emplace_back();
  contact::ContactManifold& stops = stops_[count_++];
  stops.a = manifold.a;
  stops.b = manifold.b;
  method.reduce(deep_, MOST, memory_.of(manifold), workspace, &stops.contacts);
  return stops.contacts;
}

void LayerStops::remember() {
  stops_.resize(count_);
  memory_.remember(stops_);
  any_ = count_ > 0;
}

void LayerStops::clear() {
  memory_.clear();
  any_ = false;
}

void LayerStops::forget(int collider) {
  memory_.forget(collider);
  any_ = !memory_.choices().empty();
}

void LayerStops::save(geometry::StateWriter* writer) const {
  if (any_) memory_.save(writer);
}

void LayerStops::restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader) {
  clear();
  if (reader->wordsLeft() == 0) return;
  memory_.restore(colliders, reader);
  any_ = !memory_.choices().empty();
  if (!any_) contact::refusePairs(*reader);
}

}  // namespace blem_sim::sim
