#pragma once

#include <ros/node_handle.h>

#include "loop/simulation_loop.h"
#include "publishers/reports/step_statistics.h"
#include "sending/listened_publisher.h"
#include "sending/publish_schedule.h"
#include "sending/step_publisher.h"

namespace blem_sim::node {

/** `~step_report`: status bits, real-time factor, contacts, time per stage since the last one, publishing included. */
class StepReportPublisher : public StepPublisher {
 public:
  StepReportPublisher(ros::NodeHandle private_node, SimulationLoop* loop);
  void publish(const sim::StepReport& report) override;
  void timeRestarted() override;
  void resumed() override { collector_.resume(); }
  void modelsChanged() override { collector_.forgetColliders(); }

 private:
  const SimulationLoop& loop_;
  const sim::Simulator& simulator_;
  PublishSchedule schedule_;
  ListenedPublisher publisher_;
  StepSender* sender_;
  StepStatisticsCollector collector_;
  double published_ = 0;  // [s] loop's publishing time at the last report
};

}  // namespace blem_sim::node
