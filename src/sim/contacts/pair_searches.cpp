#include "contacts/pair_searches.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "blem_sim/contact/collider_pairs.h"
#include "contacts/contact_stage.h"

namespace blem_sim::sim {

PairSearches::PairSearches(int threads) : threads_(threads), arena_(std::min(threads, tbb::this_task_arena::max_concurrency())) {}

void PairSearches::run(const std::vector<WatchedPair>& pairs, const std::function<void(std::size_t, contact::NarrowPhaseMemory*)>& search) {
  watch(pairs);
  const auto one = [&](std::size_t i) { search(i, &known_[i].memory); };
  if (threads_ == 1 || pairs.size() < 2) {
    for (std::size_t i = 0; i < pairs.size(); ++i) one(i);
  } else {
    // One by one: some searches take a thousand times as long as others.
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, pairs.size(), 1),
          [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) one(i);
          },
          tbb::simple_partitioner());
    });
  }
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
