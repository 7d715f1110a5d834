#include "lanes/slip_mixing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace blem_sim::dynamics {
namespace {

constexpr double FARTHEST_MIX = 3;  // misses: farthest that mixing goes beyond the slips found, since nothing is linear there

double innerProduct(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void subtract(const std::vector<double>& a, const std::vector<double>& b, std::vector<double>* out) {
  out->resize(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) (*out)[i] = a[i] - b[i];
}

}  // namespace

// Room for all that may come, so that a step like the ones before, or with twice the contacts, allocates nothing.
void SlipMixing::start(std::size_t lanes) {
  steps_ = 0;
  if (lanes <= shift_.capacity()) return;
  lanes *= 2;
  for (Slips* slips : {&now_, &last_, &changes_[0], &changes_[1]})
    for (std::vector<double>* v : {&slips->found, &slips->miss}) v->reserve(lanes);
  shift_.reserve(lanes);
}

// Contacts that are open miss nothing.
void SlipMixing::findSlips(ContactBlock* begin, ContactBlock* end) {
  now_.found.clear();
  now_.miss.clear();
  for (const ContactBlock* b = begin; b != end; ++b) now_.miss.insert(now_.miss.end(), b->slip, b->slip + LANES);
  blem_sim::dynamics::remember(begin, end);
  for (const ContactBlock* b = begin; b != end; ++b) now_.found.insert(now_.found.end(), b->slip, b->slip + LANES);
  std::size_t i = 0;
  for (const ContactBlock* b = begin; b != end; ++b)
    for (int lane = 0; lane < LANES; ++lane, ++i) now_.miss[i] = b->kind[lane] == ContactBlock::OPEN ? 0 : now_.found[i] - now_.miss[i];
}

// Shares of the last changes that, taken back, leave least of the miss. Zero where changes are alike to rounding.
std::array<double, SlipMixing::KEPT> SlipMixing::shares(int changes) const {
  constexpr double ALIKE = 1e-10;
  const std::vector<double>&a = changes_[0].miss, &b = changes_[1].miss;
  const double aa = innerProduct(a, a), am = innerProduct(a, now_.miss);
  if (!(aa > 0)) return {0, 0};
  if (changes < 2) return {am / aa, 0};
  const double bb = innerProduct(b, b), ab = innerProduct(a, b), bm = innerProduct(b, now_.miss), determinant = aa * bb - ab * ab;
  if (!(determinant > ALIKE * aa * bb)) return {am / aa, 0};
  return {(am * bb - bm * ab) / determinant, (bm * aa - am * ab) / determinant};
}

void SlipMixing::mix(ContactBlock* begin, ContactBlock* end) {
  Slips& change = changes_[(steps_ - 1) % KEPT];
  subtract(now_.found, last_.found, &change.found);
  subtract(now_.miss, last_.miss, &change.miss);
  const int count = std::min(steps_, KEPT);
  const std::array<double, KEPT> share = shares(count);
  shift_.assign(now_.miss.size(), 0);
  for (int k = 0; k < count; ++k)
    for (std::size_t i = 0; i < shift_.size(); ++i) shift_[i] -= share[k] * changes_[k].found[i];
  std::size_t i = 0;
  for (const ContactBlock* b = begin; b != end; ++b)
    for (int lane = 0; lane < LANES; ++lane, ++i)
      if (b->kind[lane] == ContactBlock::OPEN) shift_[i] = 0;
  const double shift = std::sqrt(innerProduct(shift_, shift_)), most = FARTHEST_MIX * std::sqrt(innerProduct(now_.miss, now_.miss));
  const double part = shift > most ? most / shift : 1;
  i = 0;
  for (ContactBlock* b = begin; b != end; ++b)
    for (int lane = 0; lane < LANES; ++lane, ++i) b->slip[lane] = std::max(0.0, b->slip[lane] + part * shift_[i]);
}

void SlipMixing::goPartOfTheWay(ContactBlock* begin, ContactBlock* end) {
  now_.found.clear();
  for (const ContactBlock* b = begin; b != end; ++b) now_.found.insert(now_.found.end(), b->slip, b->slip + LANES);
  blem_sim::dynamics::remember(begin, end);
  std::size_t i = 0;
  for (ContactBlock* b = begin; b != end; ++b)
    for (int lane = 0; lane < LANES; ++lane, ++i) b->slip[lane] = now_.found[i] + share_ * (b->slip[lane] - now_.found[i]);
}

void SlipMixing::remember(ContactBlock* begin, ContactBlock* end) {
  if (share_ < 1) return goPartOfTheWay(begin, end);
  findSlips(begin, end);
  if (steps_ > 0 && !(innerProduct(now_.miss, now_.miss) < innerProduct(last_.miss, last_.miss))) steps_ = 0;
  if (steps_ > 0) mix(begin, end);
  std::swap(now_, last_);
  ++steps_;
}

}  // namespace blem_sim::dynamics
