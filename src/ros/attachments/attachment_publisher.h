#pragma once

#include <ros/node_handle.h>

#include "sending/listened_publisher.h"
#include "sending/step_publisher.h"
#include "sending/step_sender.h"

namespace blem_sim::node {

/** `~attachments`: what is welded to what, and the wrenches between them, in every step that has any. Only with subscribers. Welds that
 * broke are also said on /rosout. */
class AttachmentPublisher : public StepPublisher {
 public:
  AttachmentPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender);
  void publish(const sim::StepReport& report) override;

 private:
  const sim::Simulator& simulator_;
  ListenedPublisher publisher_;
  StepSender* sender_;
};

}  // namespace blem_sim::node
