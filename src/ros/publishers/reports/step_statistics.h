// Statistics over several steps, for topics slower than the simulation.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "blem_sim/sim/step_report.h"

namespace blem_sim::node {

struct StepStatistics {
  std::uint32_t steps = 0;
  std::uint32_t status = sim::STEP_OK;  ///< every bit that was set
  std::uint32_t unreliable_steps = 0;   ///< steps with a contact outside the boundary layers
  double wrench_error = 0;              ///< largest
  double max_depth = 0, max_of_layer = 0;
  int deepest_a = -1, deepest_b = -1;                                       ///< colliders of the contact that used up most of its layers
  double simulated = 0, wall = 0;                                           ///< [s]
  double solver_residual = 0, solver_creep = 0;                             ///< largest
  std::uint64_t solver_iterations = 0;                                      ///< sum
  double energy_gained = 0;                                                 ///< [J] sum
  std::uint64_t contacts_left = 0;                                          ///< times that a pair left its boundary layers
  std::array<double, static_cast<int>(sim::Stage::COUNT)> stage_seconds{};  ///< sums

  /** 0 before any wall time has passed. */
  double realTimeFactor() const { return wall > 0 ? simulated / wall : 0; }
};

/** Collects statistics; wall time runs from the last take() or resume(). */
class StepStatisticsCollector {
 public:
  void add(const sim::StepReport& report);
  /** Wall time that has passed since the last step does not count. */
  void resume() { last_ = Clock::now(); }
  /** Colliders may be others now: the deepest contact so far has none. */
  void forgetColliders() { statistics_.deepest_a = statistics_.deepest_b = -1; }
  /** Returns the statistics and starts anew. */
  StepStatistics take();

 private:
  void noteDeepest(const sim::StepReport& report);

  using Clock = std::chrono::steady_clock;
  StepStatistics statistics_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace blem_sim::node
