#pragma once

#include <ros/node_handle.h>

#include "publish_schedule.h"
#include "step_publisher.h"
#include "step_statistics.h"

namespace blem_sim {

/** `~step_report`: status bits, real-time factor, contacts, time per stage since the last one. */
class StepReportPublisher : public StepPublisher {
 public:
  StepReportPublisher(ros::NodeHandle private_node, const Simulator& simulator);
  void publish(const StepReport& report) override;
  void timeRestarted() override;
  void resumed() override { collector_.resume(); }

 private:
  const Simulator& simulator_;
  PublishSchedule schedule_;
  ros::Publisher publisher_;
  StepStatisticsCollector collector_;
};

}  // namespace blem_sim
