#include "contacts/search/pair_searches.h"

#include <algorithm>
#include <utility>

namespace blem_sim::sim {
namespace {

/** Pose in which a pair was last apart, as far as the last accepted state knows. What crosses since an exchange counts as apart now. */
Recovery lastApart(const FoundContacts& before, const Pose& X_AB_now, bool crosses, const WatchedPair& pair) {
  const int a = pair.a, b = pair.b;
  if (crosses) return {a, b, true, X_AB_now};
  if (const Recovery* recovery = before.crossings.find(a, b)) return *recovery;
  if (!before.known || contact::findPair(before.watched.left_out, a, b)) return {a, b, false, Pose::Identity()};
  return {a, b, true, before.watched.motion[a].X_WC.inverse() * before.watched.motion[b].X_WC};
}

}  // namespace

PairSearches::PairSearches(StepThreads* threads) : threads_(threads), workspaces_(static_cast<std::size_t>(threads->most())) {}

void PairSearches::find(const SimulatedWorld& world, const FoundContacts& before, const FadingPoints& fading, WatchedPairs* pairs,
                        FoundContacts* found) {
  std::swap(*pairs, found->watched);
  const std::vector<WatchedPair>& watched = found->watched.pairs;
  const std::vector<contact::ColliderMotion>& motion = found->watched.motion;
  makeRoom(watched.size(), &found->manifolds);
  found->depths.resize(watched.size());
  last_apart_.resize(watched.size());
  crossed_.resize(watched.size());
  found->flush.watch(world.colliders, watched, fading);
  watch(watched);
  // One by one: some searches take a thousand times as long as others.
  threads_->forAll(watched.size(), 1, [&](std::size_t i, std::size_t thread) {
    const WatchedPair& pair = watched[i];
    Recovery& last = last_apart_[i];
    last = lastApart(before, motion[pair.a].X_WC.inverse() * motion[pair.b].X_WC, fading.crosses(pair.a, pair.b), pair);
    contact::ContactManifold& manifold = found->manifolds[i];
    contact::narrowPhase({world.colliders[pair.a], motion[pair.a].X_WC}, {world.colliders[pair.b], motion[pair.b].X_WC},
                         {pair.known, last.known ? &last.X_AB : nullptr, &known_[i].memory}, &workspaces_[thread].search, &manifold);
    manifold.a = pair.a;
    manifold.b = pair.b;
    crossed_[i] = manifold.pierced && !fading.crosses(pair.a, pair.b);
    found->flush.dropCovered(world.colliders, motion, &workspaces_[thread].cover, &manifold);
    fading.apply(world.colliders, &manifold);
    found->depths[i] = manifold.maxDepth();
  });
  found->crossings.goOn(before.crossings, last_apart_, crossed_, found->manifolds);
  keepWhatWasFound(watched.size(), found);
  found->known = true;
}

void PairSearches::know(int a, int b, contact::NarrowPhaseMemory memory) {
  Known known{std::min(a, b), std::max(a, b), std::move(memory)};
  known_.insert(std::lower_bound(known_.begin(), known_.end(), known, contact::IsPairBefore()), std::move(known));
}

void PairSearches::forget(int collider) {
  for (Known& known : known_)
    if (known.a == collider || known.b == collider) spare_.push_back(std::move(known.memory));
  contact::removePairsOf(collider, &known_);
}

void PairSearches::makeRoom(std::size_t pairs, std::vector<contact::ContactManifold>* manifolds) {
  for (; manifolds->size() < pairs && !spare_manifolds_.empty(); spare_manifolds_.pop_back())
    manifolds->push_back(std::move(spare_manifolds_.back()));
  if (manifolds->size() < pairs) manifolds->resize(pairs);
}

/** Keeps the manifolds with contacts. */
void PairSearches::keepWhatWasFound(std::size_t pairs, FoundContacts* found) {
  std::vector<contact::ContactManifold>& manifolds = found->manifolds;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs; ++i) {
    if (manifolds[i].contacts.empty()) continue;
    if (kept != i) std::swap(manifolds[kept], manifolds[i]);
    found->depths[kept++] = found->depths[i];
  }
  found->depths.resize(kept);
  for (; manifolds.size() > kept; manifolds.pop_back()) spare_manifolds_.push_back(std::move(manifolds.back()));
}

/** Makes known_ the memories of these pairs, in their order. */
void PairSearches::watch(const std::vector<WatchedPair>& pairs) {
  const auto same = [](const Known& known, const WatchedPair& pair) { return known.a == pair.a && known.b == pair.b; };
  if (std::equal(known_.begin(), known_.end(), pairs.begin(), pairs.end(), same)) return;
  std::swap(known_, before_);
  known_.clear();
  giveBack(pairs);
  auto old = before_.begin();
  for (const WatchedPair& pair : pairs) {
    while (old != before_.end() && contact::IsPairBefore()(*old, pair)) ++old;
    known_.push_back(old != before_.end() && same(*old, pair) ? std::move(*old) : Known{pair.a, pair.b, takeSpare()});
  }
  before_.clear();
}

/** Takes back the memories of pairs that are watched no more. */
void PairSearches::giveBack(const std::vector<WatchedPair>& pairs) {
  auto pair = pairs.begin();
  for (Known& old : before_) {
    while (pair != pairs.end() && contact::IsPairBefore()(*pair, old)) ++pair;
    if (pair == pairs.end() || pair->a != old.a || pair->b != old.b) spare_.push_back(std::move(old.memory));
  }
}

/** A memory whose room serves again; its content is of other meshes or another pose, which the search sees. */
contact::NarrowPhaseMemory PairSearches::takeSpare() {
  if (spare_.empty()) return contact::NarrowPhaseMemory();
  contact::NarrowPhaseMemory memory = std::move(spare_.back());
  spare_.pop_back();
  return memory;
}

}  // namespace blem_sim::sim
