#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <chrono>
#include <functional>
#include <string>

#include "loop/simulation_loop.h"
#include "publishers/reports/step_statistics.h"
#include "sending/step_publisher.h"

namespace blem_sim::node {

/** /diagnostics once per second of wall time, also while paused: speed, contacts and settings to change. */
class DiagnosticsPublisher : public StepPublisher {
 public:
  DiagnosticsPublisher(ros::NodeHandle node, ros::NodeHandle private_node, SimulationLoop* loop);
  void publish(const sim::StepReport& report) override { collector_.add(report); }
  void timeRestarted() override;
  void resumed() override { collector_.resume(); }
  void modelsChanged() override { collector_.forgetColliders(); }
  /** Adds a status of its own. */
  void add(const std::string& name, std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)> describe);
  /** Publishes when a second has passed; to be called often. */
  void serve(bool paused);

 private:
  void describeSpeed(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void describeContacts(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  const SimulationLoop& loop_;
  const sim::Simulator& simulator_;
  diagnostic_updater::Updater updater_;
  StepStatisticsCollector collector_;
  StepStatistics statistics_;                   // of the last second
  PublishingTime published_, publishing_time_;  // at the last look; of the last second
  double energy_gained_ = 0;                    // [J] since time started, until the last second
  std::uint64_t contacts_left_ = 0;
  bool paused_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace blem_sim::node
