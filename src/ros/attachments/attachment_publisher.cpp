#include "attachments/attachment_publisher.h"

#include <blem_sim/AttachmentArray.h>
#include <ros/console.h>

#include <boost/make_shared.hpp>

#include "blem_sim/sim/link_motion.h"
#include "messages/conversions.h"

namespace blem_sim::node {

namespace {

constexpr int ATTACHMENT_QUEUE = 100;

Attachment attachmentMessage(const sim::Simulator& simulator, const sim::AttachedModel& weld) {
  const Matrix3 R_LW = partMotion(simulator, weld.part).X_WL.linear().transpose();
  Attachment message;
  message.object_name = weld.object;
  message.link_name = weld.part.name;
  message.wrench = toWrench(R_LW * weld.wrench.force, R_LW * weld.wrench.torque);
  message.max_force = weld.max_force;
  message.max_torque = weld.max_torque;
  return message;
}

}  // namespace

AttachmentPublisher::AttachmentPublisher(ros::NodeHandle private_node, const sim::Simulator& simulator, StepSender* sender)
    : simulator_(simulator),
      publisher_(ListenedPublisher::advertise<AttachmentArray>(&private_node, "attachments", ATTACHMENT_QUEUE)),
      sender_(sender) {}

void AttachmentPublisher::publish(const sim::StepReport& report) {
  for (const std::string& object : report.broken_attachments)
    ROS_WARN("t = %.3f s: the weld of '%s' broke; a larger max_force or max_torque of ~attach holds it", report.time, object.c_str());
  if ((simulator_.attachments().empty() && report.broken_attachments.empty()) || !publisher_.listened()) return;
  const auto message = boost::make_shared<AttachmentArray>();
  message->header.stamp = toStamp(report.time);
  message->header.frame_id = WORLD_FRAME;
  for (const sim::AttachedModel& weld : simulator_.attachments()) message->attachments.push_back(attachmentMessage(simulator_, weld));
  message->broken = report.broken_attachments;
  sender_->add(&publisher_, message);
}

}  // namespace blem_sim::node
