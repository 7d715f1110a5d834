#pragma once

#include <blem_sim/LayerEvent.h>
#include <ros/node_handle.h>

#include "sending/greeting_publisher.h"
#include "sending/step_publisher.h"
#include "sending/step_sender.h"

namespace blem_sim::node {

/**
 * `~layer_events`: one message per contact that leaves its boundary layers or comes back. None is dropped, and late subscribers are told
 * the last one. Contacts that left are also said on /rosout, at most once in WARNING_PERIOD.
 */
class LayerEventPublisher : public StepPublisher {
 public:
  static constexpr double WARNING_PERIOD = 1;  // [s] simulated
  LayerEventPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender);
  void publish(const sim::StepReport& report) override;
  void timeRestarted() override;

 private:
  void warn(const LayerEvent& event, double time);

  const sim::Simulator& simulator_;
  StepSender* sender_;
  GreetingPublisher<LayerEvent> publisher_;
  double next_warning_ = 0;  // [s] simulated
  unsigned unsaid_ = 0;      // since the last warning
};

}  // namespace blem_sim::node
