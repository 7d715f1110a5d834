// Topics that the node advertises for itself.
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {

/** Advertises a topic. @throws InputError: the node has the topic for another kind of message, which roscpp answers by no publisher */
inline ros::Publisher advertiseOwn(ros::NodeHandle* node, ros::AdvertiseOptions options) {
  const ros::Publisher publisher = node->advertise(options);
  if (!publisher)
    throw InputError("topic " + node->resolveName(options.topic) +
                     ": the node has two kinds of messages for it; give the sensor, odom or controller that takes this name another one");
  return publisher;
}

}  // namespace blem_sim::node
