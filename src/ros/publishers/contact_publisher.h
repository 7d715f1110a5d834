#pragma once

#include <ros/node_handle.h>

#include "messages/message_pool.h"
#include "publishers/markers/contact_markers.h"
#include "sending/listened_publisher.h"
#include "sending/publish_schedule.h"
#include "sending/step_publisher.h"
#include "sending/step_sender.h"

namespace blem_sim::node {

/** `~contacts`: every contact that acted in the step at hand. Only with subscribers. */
class ContactPublisher : public StepPublisher {
 public:
  ContactPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender);
  void publish(const sim::StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }

 private:
  const sim::Simulator& simulator_;
  PublishSchedule schedule_;
  ListenedPublisher publisher_;
  StepSender* sender_;
};

/**
 * `~contact_markers`: points and force arrows, green within the boundary layers, to yellow as they are used up, red once bare meshes cross.
 * The weight of all that moves would be an arrow of LENGTH_OF_WEIGHT; none is longer than ContactMarkers::LONGEST_ARROW. Only with
 * subscribers.
 */
class ContactMarkerPublisher : public StepPublisher {
 public:
  static constexpr double LENGTH_OF_WEIGHT = 0.8;  // [m]
  ContactMarkerPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender);
  void publish(const sim::StepReport& report) override;
  void timeRestarted() override { schedule_.restart(); }
  void modelsChanged() override;

 private:
  const sim::Simulator& simulator_;
  PublishSchedule schedule_;
  ContactMarkers markers_;                 // the sender's
  MessagePool<StampedContacts> contacts_;  // to make them from
  StepSender* sender_;
};

}  // namespace blem_sim::node
