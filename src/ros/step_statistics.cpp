#include "step_statistics.h"

#include <algorithm>
#include <utility>

namespace blem_sim {

void StepStatisticsCollector::add(const StepReport& report) {
  const Clock::time_point now = Clock::now();
  statistics_.wall += std::chrono::duration<double>(now - last_).count();
  last_ = now;
  statistics_.simulated += report.dt;
  ++statistics_.steps;
  statistics_.status |= report.status;
  if (report.max_of_layer > 1 || (report.status & CONTACT_UNRELIABLE) != 0) ++statistics_.unreliable_steps;
  if (report.max_of_layer > statistics_.max_of_layer) {
    statistics_.max_of_layer = report.max_of_layer;
    statistics_.max_depth = report.max_depth;
    statistics_.deepest_a = report.deepest_a;
    statistics_.deepest_b = report.deepest_b;
  }
  statistics_.solver_residual = std::max(statistics_.solver_residual, report.solver_residual);
  statistics_.solver_creep = std::max(statistics_.solver_creep, report.solver_creep);
  statistics_.solver_iterations += report.solver_iterations;
  for (std::size_t i = 0; i < statistics_.stage_seconds.size(); ++i) statistics_.stage_seconds[i] += report.profile.seconds[i];
}

StepStatistics StepStatisticsCollector::take() { return std::exchange(statistics_, StepStatistics()); }

}  // namespace blem_sim
