// Wall time of the stages of a step.
#pragma once

#include <chrono>

#include "blem_sim/sim/step_report.h"

namespace blem_sim::sim {

/** Adds the wall time of a scope to a stage. */
class StageTimer {
 public:
  StageTimer(StepProfile* profile, Stage stage) : seconds_(&profile->seconds[static_cast<int>(stage)]), start_(Clock::now()) {}
  ~StageTimer() { *seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double* seconds_;
  Clock::time_point start_;
};

}  // namespace blem_sim::sim
