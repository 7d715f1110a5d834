#include <algorithm>

#include "blem_sim/contact/collider_pairs.h"
#include "blem_sim/reduction/reduction.h"

namespace blem_sim::reduction {

const ContactIds& ReductionMemory::of(const contact::ContactManifold& manifold) const {
  static const ContactIds nothing;
  const Choice* choice = contact::findPair(choices_, manifold.a, manifold.b);
  return choice ? choice->ids : nothing;
}

void ReductionMemory::remember(const std::vector<contact::ContactManifold>& manifolds) {
  choices_.resize(manifolds.size());
  for (std::size_t m = 0; m < manifolds.size(); ++m) {
    choices_[m].a = manifolds[m].a;
    choices_[m].b = manifolds[m].b;
    choices_[m].ids.clear();
    for (const contact::Contact& contact : manifolds[m].contacts) choices_[m].ids.push_back(contact.id);
    // Most methods sort by id.
    if (!std::is_sorted(choices_[m].ids.begin(), choices_[m].ids.end())) std::sort(choices_[m].ids.begin(), choices_[m].ids.end());
  }
}

void ReductionMemory::save(geometry::StateWriter* writer) const {
  writer->word(choices_.size());
  for (const Choice& choice : choices_) {
    writer->integer(choice.a);
    writer->integer(choice.b);
    writer->word(choice.ids.size());
    writer->words(choice.ids);
  }
}

void ReductionMemory::forget(int collider) { contact::removePairsOf(collider, &choices_); }

void ReductionMemory::restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader) {
  choices_.clear();
  for (std::size_t pairs = reader->count(3, 0); pairs > 0; --pairs) {
    const auto [a, b] = contact::readPair(colliders, reader);
    choices_.push_back({a, b, reader->words(reader->count(1, 0))});
    if (!std::is_sorted(choices_.back().ids.begin(), choices_.back().ids.end())) contact::refusePairs(*reader);
  }
  if (!contact::areSorted(choices_)) contact::refusePairs(*reader);
}

}  // namespace blem_sim::reduction
