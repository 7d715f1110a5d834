#include "sweeps/sweep_lead.h"

#include <algorithm>
#include <limits>

#include "lanes/lanes.h"

namespace blem_sim::dynamics {
namespace {

constexpr double MOST_GROWTH = 1.5;  // of squared changes since their least, while sweeps are led on

BLEM_SIM_LANES void moveOn(double share, double* begin, double* end, double* before) {
  for (double* x = begin; x < end; ++x, ++before) {
    const double now = *x;
    *x += share * (now - *before);
    *before = now;
  }
}

}  // namespace

void SweepLead::start(int numbers) { before_.assign(numbers, 0); }

void SweepLead::beginRun() {
  sweeps_ = 0;
  least_ = std::numeric_limits<double>::infinity();
}

void SweepLead::take(double change) {
  ++sweeps_;
  const bool well = change <= MOST_GROWTH * least_;
  if (!well) sweeps_ = 0;
  least_ = well ? std::min(least_, change) : change;
}

void SweepLead::move(double* begin, double* end, double* before) const { moveOn(share(), begin, end, before); }

void SweepLead::moveVelocities(int first, int end, double* velocities) {
  move(velocities + first, velocities + end, before_.data() + first);
}

}  // namespace blem_sim::dynamics
