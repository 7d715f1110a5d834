#pragma once

#include <ros/node_handle.h>

#include "publish_schedule.h"
#include "step_publisher.h"
#include "step_sender.h"

namespace blem_sim {

/** `~contacts`: every contact that acted in the step at hand. Only with subscribers. */
class ContactPublisher : public StepPublisher {
 public:
  ContactPublisher(ros::NodeHandle private_node, const Simulator& simulator);
  void publish(const StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }

 private:
  const Simulator& simulator_;
  PublishSchedule schedule_;
  ros::Publisher publisher_;
};

/**
 * `~contact_markers`: points and force arrows, green within the boundary layers, to yellow as they are used up, red once bare meshes cross.
 * The weight of all that moves would be an arrow of LENGTH_OF_WEIGHT; none is longer than LONGEST_ARROW. Only with subscribers.
 */
class ContactMarkerPublisher : public StepPublisher {
 public:
  static constexpr double LENGTH_OF_WEIGHT = 0.8;  // [m]
  static constexpr double LONGEST_ARROW = 0.25;    // [m]
  ContactMarkerPublisher(ros::NodeHandle private_node, const Simulator& simulator, StepSender* sender);
  void publish(const StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }

 private:
  const Simulator& simulator_;
  PublishSchedule schedule_;
  ros::Publisher publisher_;
  StepSender* sender_;
  double metres_per_newton_;
  std::size_t arrows_ = 0;  // shown now
};

}  // namespace blem_sim
