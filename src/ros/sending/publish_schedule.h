// Schedule of a topic: the steps at which its rate is due.
#pragma once

#include <cmath>
#include <cstdint>

namespace blem_sim::node {

/** Counts periods of simulated time, so that rates hold on average whatever the step. */
class PublishSchedule {
 public:
  /** @param rate [Hz]; 0 = every step, below 0 = never */
  explicit PublishSchedule(double rate) : rate_(rate) {}

  /** True once per period: at the first step at or after each multiple of it. @param time [s] simulated */
  bool due(double time) {
    if (rate_ <= 0) return rate_ == 0;
    // A multiple of the step may fall short of a multiple of the period by rounding.
    const auto period = static_cast<std::int64_t>(std::floor(time * rate_ + 1e-6));
    if (period == last_period_) return false;
    last_period_ = period;
    return true;
  }
  void restart() { last_period_ = -1; }

 private:
  double rate_;
  std::int64_t last_period_ = -1;
};

}  // namespace blem_sim::node
