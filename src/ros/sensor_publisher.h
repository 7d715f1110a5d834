#pragma once

#include <ros/node_handle.h>

#include <vector>

#include "step_publisher.h"
#include "step_sender.h"

namespace blem_sim {

/** One topic per sensor, in its robot's namespace; a sensor's rate was kept when it was sampled. */
class SensorPublisher : public StepPublisher {
 public:
  /** @throws InputError: a sensor's topic is no valid ROS name, or two sensors share one */
  SensorPublisher(ros::NodeHandle node, const Simulator& simulator, StepSender* sender);
  void publish(const StepReport& report) override;

 private:
  void publishMountings();

  const Simulator& simulator_;
  StepSender* sender_;
  ros::NodeHandle node_;
  std::vector<ros::Publisher> publishers_;  // per sensor
  std::vector<std::string> frames_;         // per sensor: frame_id of its messages
  ros::Publisher mountings_;                // /tf_static of sensors that sit askew in their link
};

}  // namespace blem_sim
