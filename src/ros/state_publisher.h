#pragma once

#include <ros/node_handle.h>

#include "publish_schedule.h"
#include "step_publisher.h"

namespace blem_sim {

/** `~link_states` and `~model_states` in Gazebo's layout: every link of every robot, every object, every environment. Only with
 * subscribers. */
class StatePublisher : public StepPublisher {
 public:
  StatePublisher(ros::NodeHandle private_node, const Simulator& simulator);
  void publish(const StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }

 private:
  void publishLinks(const StepReport& report);
  void publishModels(const StepReport& report);

  const Simulator& simulator_;
  PublishSchedule schedule_;
  ros::Publisher links_, models_;
};

}  // namespace blem_sim
