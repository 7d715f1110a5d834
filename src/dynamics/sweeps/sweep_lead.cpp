#include "sweeps/sweep_lead.h"

#include <algorithm>
#include <limits>

namespace blem_sim::dynamics {
namespace {

constexpr double MOST_GROWTH = 1.5;  // of squared changes since their least, while sweeps are led on

}  // namespace

void SweepLead::start(int numbers) {
  search_.assign(numbers, 0);
  before_.resize(numbers);
}

void SweepLead::beginRun() {
  moves_ = false;
  sweeps_ = 0;
  least_ = std::numeric_limits<double>::infinity();
}

void SweepLead::take(double change) {
  moves_ = true;
  ++sweeps_;
  const bool well = change <= MOST_GROWTH * least_;
  if (!well) sweeps_ = 0;
  least_ = well ? std::min(least_, change) : change;
}

void SweepLead::move(SweepImpulse* begin, SweepImpulse* end) const {
  if (moves_) moveOn(share(), begin, end);
}

void SweepLead::move(double* number, Led* led) const {
  if (moves_) {
    const double along = share() * led->search, change = *number - led->before;
    *number += along;
    led->search = along + change;
  }
  led->before = *number;
}

void SweepLead::move(int first, int end, double* velocities) {
  for (int i = first; i < end; ++i) {
    double& v = velocities[i];
    if (moves_) {
      const double along = share() * search_[i], change = v - before_[i];
      v += along;
      search_[i] = along + change;
    }
    before_[i] = v;
  }
}

}  // namespace blem_sim::dynamics
