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

void ReductionMemory::append(std::vector<std::uint64_t>* words) const {
  words->push_back(choices_.size());
  for (const Choice& choice : choices_) {
    words->insert(words->end(), {static_cast<std::uint64_t>(choice.a), static_cast<std::uint64_t>(choice.b), choice.ids.size()});
    words->insert(words->end(), choice.ids.begin(), choice.ids.end());
  }
}

void ReductionMemory::forget(int collider) { contact::removePairsOf(collider, &choices_); }

bool ReductionMemory::read(const std::vector<contact::Collider>& colliders, const std::uint64_t** cursor, const std::uint64_t* end) {
  const auto left = [&] { return static_cast<std::uint64_t>(end - *cursor); };
  choices_.clear();
  if (left() < 1) return false;
  for (std::uint64_t pairs = *(*cursor)++; pairs > 0; --pairs) {
    if (left() < 3 || left() - 3 < (*cursor)[2]) return false;
    const std::uint64_t *ids = *cursor + 3, *ids_end = ids + (*cursor)[2];
    if (!contact::isPair(colliders, (*cursor)[0], (*cursor)[1]) || !std::is_sorted(ids, ids_end)) return false;
    choices_.push_back({static_cast<int>((*cursor)[0]), static_cast<int>((*cursor)[1]), ContactIds(ids, ids_end)});
    *cursor = ids_end;
  }
  return contact::areSorted(choices_);
}

}  // namespace blem_sim::reduction
