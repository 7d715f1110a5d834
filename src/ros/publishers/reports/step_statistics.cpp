#include "publishers/reports/step_statistics.h"

#include <algorithm>
#include <utility>

namespace blem_sim::node {

void StepStatisticsCollector::add(const sim::StepReport& report) {
  const Clock::time_point now = Clock::now();
  statistics_.wall += std::chrono::duration<double>(now - last_).count();
  last_ = now;
  statistics_.simulated += report.dt;
  ++statistics_.steps;
  statistics_.status |= report.status;
  if (report.max_of_layer > 1 || (report.status & sim::CONTACT_UNRELIABLE) != 0) ++statistics_.unreliable_steps;
  if (report.max_of_layer > statistics_.max_of_layer) {
    statistics_.max_of_layer = report.max_of_layer;
    noteDeepest(report);
  }
  statistics_.wrench_error = std::max(statistics_.wrench_error, report.wrench_error);
  statistics_.solver_residual = std::max(statistics_.solver_residual, report.solver_residual);
  statistics_.solver_creep = std::max(statistics_.solver_creep, report.solver_creep);
  statistics_.solver_iterations += report.solver_iterations;
  statistics_.energy_gained += report.energy_gained;
  statistics_.contacts_left += std::count_if(report.layer_events.begin(), report.layer_events.end(),
                                             [](const sim::LayerEventReport& event) { return event.outside; });
  for (std::size_t i = 0; i < statistics_.stage_seconds.size(); ++i) statistics_.stage_seconds[i] += report.profile.seconds[i];
}

// The deepest contact need not be the one that used up most of its layers.
void StepStatisticsCollector::noteDeepest(const sim::StepReport& report) {
  const auto most_used = std::find_if(report.contacts.begin(), report.contacts.end(),
                                      [&report](const sim::ContactReport& contact) { return contact.of_layer == report.max_of_layer; });
  const bool found = most_used != report.contacts.end();
  statistics_.max_depth = found ? most_used->depth : report.max_depth;
  statistics_.deepest_a = found ? most_used->collider_a : report.deepest_a;
  statistics_.deepest_b = found ? most_used->collider_b : report.deepest_b;
}

StepStatistics StepStatisticsCollector::take() { return std::exchange(statistics_, StepStatistics()); }

}  // namespace blem_sim::node
