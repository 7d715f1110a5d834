#pragma once

#include <ros/node_handle.h>

#include "sending/listened_publisher.h"
#include "sending/publish_schedule.h"
#include "sending/step_publisher.h"
#include "sending/step_sender.h"

namespace blem_sim::node {

/** `~link_states` and `~model_states` in Gazebo's layout: every link of every robot, every object, every environment. Only with
 * subscribers. */
class StatePublisher : public StepPublisher {
 public:
  StatePublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender);
  void publish(const sim::StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }

 private:
  void publishLinks(const sim::StepReport& report);
  void publishModels(const sim::StepReport& report);

  const sim::Simulator& simulator_;
  PublishSchedule schedule_;
  ListenedPublisher links_, models_;
  StepSender* sender_;
};

}  // namespace blem_sim::node
