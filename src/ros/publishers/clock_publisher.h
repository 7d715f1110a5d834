#pragma once

#include <ros/node_handle.h>
#include <rosgraph_msgs/Clock.h>

#include "messages/message_pool.h"
#include "sending/greeting_publisher.h"
#include "sending/publish_schedule.h"
#include "sending/step_publisher.h"
#include "sending/step_sender.h"

namespace blem_sim::node {

/** /clock: strictly increasing stamps until time is restarted. A node that starts during a pause is told the time. */
class ClockPublisher : public StepPublisher {
 public:
  ClockPublisher(ros::NodeHandle node, double rate, StepSender* sender);
  void publish(const sim::StepReport& report) override;
  void timeRestarted() override;

 private:
  GreetingPublisher<rosgraph_msgs::Clock> publisher_;
  MessagePool<rosgraph_msgs::Clock> messages_;
  PublishSchedule schedule_;
  StepSender* sender_;
  bool published_ = false;
  bool restarted_ = false;  ///< and nothing was published since
  ros::Time last_;
};

}  // namespace blem_sim::node
