#include "iterate/island_contacts.h"

#include <algorithm>

namespace blem_sim::dynamics {
namespace {

constexpr std::size_t BLOCKS_AT_ONCE = 128;  // the size of a chunk: some microseconds

}  // namespace

/** Blocks, which threads share: visit(index of the range, first, end). */
template <typename Visit>
void IslandContacts::forRanges(const Visit& visit) {
  island_->team->forRanges(0, blocks_.size(), BLOCKS_AT_ONCE,
                           [&](std::size_t first, std::size_t end) { visit(first / BLOCKS_AT_ONCE, begin() + first, begin() + end); });
}

void IslandContacts::fill(const IslandAtHand& island) {
  island_ = &island;
  ranges_.clear();
  const std::vector<ContactTerm>& terms = island.terms()->contacts;
  std::size_t count = 0;
  for (const PairContacts& p : island.model.pairs) {
    const std::size_t start = count;
    count += (p.end - p.first + LANES - 1) / LANES;
    ranges_.push_back({start, count});
  }
  blocks_.resize(count);
  forPairs(island, [&](std::size_t index) {
    const PairContacts& p = island.model.pairs[index];
    std::size_t b = ranges_[index].first;
    for (int first = p.first; first < p.end; first += LANES, ++b) {
      blocks_[b] = ContactBlock();
      for (int lane = 0; lane < LANES; ++lane) setLane(first + lane < p.end ? &terms[first + lane] : nullptr, lane, &blocks_[b]);
    }
  });
}

void IslandContacts::soften(double softness) {
  softness_ = softness;
  const std::vector<ContactTerm>& terms = island_->terms()->contacts;
  forPairs(*island_, [&](std::size_t index) {
    const PairContacts& p = island_->model.pairs[index];
    int i = p.first;
    for (std::size_t b = ranges_[index].first; b < ranges_[index].end; ++b, i += LANES)
      dynamics::soften(&terms[i], p.end - i, softness, &blocks_[b]);
  });
}

void IslandContacts::setSteps() {
  forPairs(*island_, [&](std::size_t p) {
    dynamics::setSteps(relativeTwist(island_->model.pairs[p].pair, island_->space->twist), begin() + ranges_[p].first,
                       begin() + ranges_[p].end);
  });
}

void IslandContacts::take(double a) {
  forRanges([a](std::size_t, ContactBlock* first, ContactBlock* end) { dynamics::take(a, first, end); });
}

void IslandContacts::expect() {
  forRanges([](std::size_t, ContactBlock* first, ContactBlock* end) { dynamics::expect(first, end); });
}

PotentialSlope IslandContacts::respond(double a) {
  slopes_.assign(blocks_.size() / BLOCKS_AT_ONCE + 1, PotentialSlope());
  forRanges([&](std::size_t range, ContactBlock* first, ContactBlock* end) { slopes_[range] = dynamics::respond(a, first, end); });
  PotentialSlope slope = slopes_[0];
  for (std::size_t range = 1; range < slopes_.size(); ++range) slope += slopes_[range];
  return slope;
}

void IslandContacts::adoptImpulses() {
  forEach([&](int contact, std::size_t block, int lane) {
    for (int axis = 0; axis < 3; ++axis) blocks_[block].impulse[axis][lane] = island_->terms()->contacts[contact].impulse[axis];
  });
  dynamics::remember(begin(), end());
}

void IslandContacts::read() const {
  forEach([&](int contact, std::size_t block, int lane) { readLane(blocks_[block], lane, &island_->terms()->contacts[contact]); });
}

void IslandContacts::addWrenches() {
  pair_wrenches_.resize(ranges_.size());
  forPairs(*island_, [&](std::size_t p) { pair_wrenches_[p] = wrenchOf(begin() + ranges_[p].first, begin() + ranges_[p].end); });
  for (std::size_t p = 0; p < ranges_.size(); ++p) addWrench(island_->model.pairs[p].pair, pair_wrenches_[p], &island_->space->wrench);
}

bool IslandContacts::stiffnessOf(std::size_t pair, Matrix6* out) const {
  return dynamics::stiffnessOf(begin() + ranges_[pair].first, begin() + ranges_[pair].end, out);
}

bool IslandContacts::areSettled(double share) const {
  double change = 0, largest = 0;
  for (const ContactBlock& b : blocks_) {
    for (int lane = 0; lane < LANES; ++lane) {
      double changed = 0, impulse = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double g = b.impulse[axis][lane], by = g - b.previous[axis][lane];
        changed += by * by;
        impulse += g * g;
      }
      change = std::max(change, changed);
      largest = std::max(largest, impulse);
    }
  }
  return change <= share * share * largest;
}

}  // namespace blem_sim::dynamics
