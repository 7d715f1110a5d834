#include "contacts/layer_stops.h"

namespace blem_sim::sim {

const std::vector<contact::Contact>& LayerStops::choose(const contact::ContactManifold& manifold, const reduction::Reduction& method) {
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
  method.reduce(deep_, MOST, memory_.of(manifold), &stops.contacts);
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

void LayerStops::append(std::vector<std::uint64_t>* words) const {
  if (any_) memory_.append(words);
}

bool LayerStops::read(const std::vector<contact::Collider>& colliders, const std::uint64_t* words, const std::uint64_t* end) {
  clear();
  if (words == end) return true;
  any_ = memory_.read(colliders, &words, end) && !memory_.choices().empty();
  return any_ && words == end;
}

}  // namespace blem_sim::sim
