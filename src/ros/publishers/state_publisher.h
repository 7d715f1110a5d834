#pragma once

#include <ros/node_handle.h>

#include "sending/listened_publisher.h"
#include "sending/publish_schedule.h"
#include "sending/step_publisher.h"
#include "sending/step_sender.h"

namespace blem_sim {

/** `~link_states` and `~model_states` in Gazebo's layout: every link of every robot, every object, every environment. Only with
 * subscribers. */
class StatePublisher : public StepPublisher {
 public:
  StatePublisher(ros::NodeHandle private_node, const Simulator& simulator, StepSender* sender);
  void publish(const StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }

 private:
  void publishLinks(const StepReport& report);
  void publishModels(const StepReport& report);

  const Simulator& simulator_;
  PublishSchedule schedule_;
  ListenedPublisher links_, models_;
  StepSender* sender_;
};

}  // namespace blem_sim
