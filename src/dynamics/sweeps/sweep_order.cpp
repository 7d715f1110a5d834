#include "sweeps/sweep_order.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace blem_sim::dynamics {
namespace {

constexpr int COLOURS = 64;  // beyond, pairs of one body take turns one by one

}  // namespace

void SweepOrder::find(const IslandAtHand& island, const IslandResponse& response, const std::vector<ResponsePair>& pairs,
                      std::vector<SweepGroup>* groups) {
  island_ = &island;
  response_ = &response;
  pairs_ = &pairs;
  regions_.find(island, response, pairs);
  sort();
  colour_.resize(order_.size());
  groups->clear();
  groups_start_.assign(1, 0);
  for (int r = 0; r <= regions_.count(); ++r) {
    colourPairs(region_start_[r], region_start_[r + 1]);
    sortByColour(region_start_[r], region_start_[r + 1]);
    border_start_.assign(1, groups->size());
    for (int c = 0; c <= COLOURS; ++c) {
      layGroups(c, groups);
      border_start_.push_back(groups->size());
    }
    groups_start_.push_back(groups->size());
  }
}

GroupRange SweepOrder::groupsOf(int region) const { return {groups_start_[region], groups_start_[region + 1]}; }

void SweepOrder::sort() {
  heights_.clear();
  region_.clear();
  region_start_.assign(regions_.count() + 2, 0);
  for (std::size_t p = 0; p < pairs_->size(); ++p) {
    const PairContacts& of_pair = island_->model.pairs[p];
    const Vector3& reference = island_->motion.reference[island_->forest.nodes()[of_pair.pair.a].tree];
    heights_.push_back(island_->model.up.dot(reference + island_->terms()->contacts[of_pair.first].point));
    region_.push_back(regions_.ofPair(*response_, (*pairs_)[p]));
    ++region_start_[region_.back() + 1];
  }
  std::partial_sum(region_start_.begin(), region_start_.end(), region_start_.begin());
  order_.resize(pairs_->size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(),
            [this](int a, int b) { return std::tie(region_[a], heights_[a], a) < std::tie(region_[b], heights_[b], b); });
}

void SweepOrder::colourPairs(std::size_t begin, std::size_t end) {
  used_colours_.assign(response_->movers(), 0);
  for (std::size_t i = begin; i < end; ++i) {
    const int p = order_[i];
    const ResponsePair& pair = (*pairs_)[p];
    std::uint64_t used = used_colours_[response_->moverOf(pair.a)];
    const bool two = pair.pair.b >= 0;
    if (two) used |= used_colours_[response_->moverOf(pair.b)];
    int colour = 0;
    while (colour < COLOURS && (used >> colour & 1)) ++colour;
    colour_[p] = colour;
    if (colour == COLOURS) continue;
    used_colours_[response_->moverOf(pair.a)] |= std::uint64_t{1} << colour;
    if (two) used_colours_[response_->moverOf(pair.b)] |= std::uint64_t{1} << colour;
  }
}

// Pairs of a colour are sorted by size, so that those of a group have about as many contacts; those without a colour keep their order.
void SweepOrder::sortByColour(std::size_t begin, std::size_t end) {
  colour_start_.assign(COLOURS + 2, 0);
  for (std::size_t i = begin; i < end; ++i) ++colour_start_[colour_[order_[i]] + 1];
  std::partial_sum(colour_start_.begin(), colour_start_.end(), colour_start_.begin());
  by_colour_.resize(end - begin);
  chosen_.assign(colour_start_.begin(), colour_start_.end() - 1);
  for (std::size_t i = begin; i < end; ++i) by_colour_[chosen_[colour_[order_[i]]]++] = order_[i];
  for (int c = 0; c < COLOURS; ++c)
    std::sort(by_colour_.begin() + colour_start_[c], by_colour_.begin() + colour_start_[c + 1],
              [&](int a, int b) { return contactsOf(a) > contactsOf(b) || (contactsOf(a) == contactsOf(b) && a < b); });
}

void SweepOrder::layGroups(int colour, std::vector<SweepGroup>* groups) const {
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
}

}  // namespace blem_sim::dynamics
