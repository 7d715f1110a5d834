#include "island/sweep_order.h"

#include <algorithm>
#include <numeric>

namespace blem_sim::dynamics {
namespace {

constexpr int COLOURS = 64;  // beyond, pairs of one body take turns one by one

}  // namespace

void SweepOrder::find(const IslandAtHand& island, const IslandResponse& response, const std::vector<ResponsePair>& pairs,
                      std::vector<SweepGroup>* groups) {
  island_ = &island;
  sortByHeight();
  colourPairs(response, pairs);
  sortByColour();
  groups->clear();
  group_start_.assign(1, 0);
  for (int c = 0; c <= COLOURS; ++c) layGroups(c, groups);
}

// Orders the pairs from the ground up.
void SweepOrder::sortByHeight() {
  heights_.clear();
  for (const PairContacts& of_pair : island_->model.pairs) {
    const Vector3& reference = island_->motion.reference[island_->forest.nodes()[of_pair.pair.a].tree];
    heights_.push_back(island_->model.up.dot(reference + island_->terms()->contacts[of_pair.first].point));
  }
  order_.resize(heights_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(),
            [this](int a, int b) { return heights_[a] < heights_[b] || (heights_[a] == heights_[b] && a < b); });
}

void SweepOrder::colourPairs(const IslandResponse& response, const std::vector<ResponsePair>& pairs) {
  used_colours_.assign(response.movers(), 0);
  colour_.resize(order_.size());
  for (const int p : order_) {
    std::uint64_t used = used_colours_[response.moverOf(pairs[p].a)];
    const bool two = pairs[p].pair.b >= 0;
    if (two) used |= used_colours_[response.moverOf(pairs[p].b)];
    int colour = 0;
    while (colour < COLOURS && (used >> colour & 1)) ++colour;
    colour_[p] = colour;
    if (colour == COLOURS) continue;
    used_colours_[response.moverOf(pairs[p].a)] |= std::uint64_t{1} << colour;
    if (two) used_colours_[response.moverOf(pairs[p].b)] |= std::uint64_t{1} << colour;
  }
}

// Pairs of a colour are sorted by size, so that those of a group have about as many contacts; those without a colour keep their order.
void SweepOrder::sortByColour() {
  colour_start_.assign(COLOURS + 2, 0);
  for (const int p : order_) ++colour_start_[colour_[p] + 1];
  for (int c = 0; c <= COLOURS; ++c) colour_start_[c + 1] += colour_start_[c];
  by_colour_.resize(order_.size());
  chosen_.assign(colour_start_.begin(), colour_start_.end() - 1);
  for (const int p : order_) by_colour_[chosen_[colour_[p]]++] = p;
  for (int c = 0; c < COLOURS; ++c)
    std::sort(by_colour_.begin() + colour_start_[c], by_colour_.begin() + colour_start_[c + 1],
              [&](int a, int b) { return contactsOf(a) > contactsOf(b) || (contactsOf(a) == contactsOf(b) && a < b); });
}

void SweepOrder::layGroups(int colour, std::vector<SweepGroup>* groups) {
  const auto end = by_colour_.begin() + colour_start_[colour + 1];
  const int width = colour < COLOURS ? SWEEP_LANES : 1;
  for (auto p = by_colour_.begin() + colour_start_[colour]; p != end;) {
    SweepGroup group;
    group.first = groups->empty() ? 0 : groups->back().end;
    int longest = 0;
    for (int lane = 0; lane < SWEEP_LANES; ++lane) {
      group.pair[lane] = lane < width && p != end ? *p++ : -1;
      if (group.pair[lane] >= 0) longest = std::max(longest, contactsOf(group.pair[lane]));
    }
    group.end = group.first + longest;
    groups->push_back(group);
  }
  group_start_.push_back(groups->size());
}

}  // namespace blem_sim::dynamics
