#include "loop/step_pacer.h"

#include <algorithm>

namespace blem_sim::node {

namespace {
StepPacer::Clock::duration toDuration(double seconds) {
  return std::chrono::duration_cast<StepPacer::Clock::duration>(std::chrono::duration<double>(seconds));
}
}  // namespace

StepPacer::StepPacer(double real_time_factor, double time_step, bool is_busy)
    : period_(real_time_factor > 0 ? toDuration(time_step / real_time_factor) : Clock::duration::zero()),
      due_(Clock::now()),
      is_busy_(is_busy) {}

void StepPacer::restart(Clock::time_point now) { due_ = now; }

double StepPacer::wait(Clock::time_point now) const {
  return period_ == Clock::duration::zero() ? 0.0 : std::max(0.0, std::chrono::duration<double>(due_ - now).count());
}

void StepPacer::stepped(Clock::time_point now) { due_ = std::max(due_ + period_, now - toDuration(MAX_BACKLOG)); }

}  // namespace blem_sim::node
