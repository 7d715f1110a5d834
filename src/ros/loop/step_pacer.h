// Due times of steps on the wall clock.
#pragma once

#include <chrono>

namespace blem_sim::node {

/** Keeps simulated time at real_time_factor times wall time. A late simulation catches up at most MAX_BACKLOG. */
class StepPacer {
 public:
  using Clock = std::chrono::steady_clock;
  /** [s] wall time that may be caught up; a larger backlog is given up, so that a pause of the machine makes no burst. */
  static constexpr double MAX_BACKLOG = 0.02;

  /** @param real_time_factor 0 = as fast as possible. @param time_step [s]. @param is_busy SimulationConfig::busy_wait */
  StepPacer(double real_time_factor, double time_step, bool is_busy = false);
  /** The first step is due now: at the start and after a pause. */
  void restart(Clock::time_point now);
  /** [s] wall time until the next step is due; 0 = now. */
  double wait(Clock::time_point now) const;
  /** [s] wall time that the stepping thread may sleep. */
  double sleep(Clock::time_point now) const { return is_busy_ ? 0.0 : wait(now); }
  /** A step was made: the next one is due one period later. */
  void stepped(Clock::time_point now);

 private:
  Clock::duration period_;
  Clock::time_point due_;
  bool is_busy_;
};

}  // namespace blem_sim::node
