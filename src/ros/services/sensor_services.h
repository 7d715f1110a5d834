#pragma once

#include <ros/node_handle.h>

#include <map>
#include <string>
#include <utility>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::node {

/** `TOPIC/tare` (std_srvs/Trigger) of each force-torque sensor: what it measures next is its zero from then on. */
class SensorServices {
 public:
  SensorServices(ros::NodeHandle node, sim::Simulator* simulator);
  /** Robots, and so sensors, came or went. */
  void modelsChanged();

 private:
  using Names = std::pair<std::string, std::string>;  ///< of a robot and its sensor
  ros::ServiceServer advertiseTare(const sim::SensorInfo& sensor, const Names& names);

  ros::NodeHandle node_;
  sim::Simulator* simulator_;
  std::map<Names, ros::ServiceServer> tares_;
};

}  // namespace blem_sim::node
