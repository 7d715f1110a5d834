// Places of sensors' frames, from /tf.
#pragma once

#include <ros/time.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <atomic>
#include <string>

#include "blem_sim/geometry/types.h"

namespace blem_sim::node {

/** Listens to /tf and /tf_static in a thread of its own. Any thread may ask. */
class CloudFrames {
 public:
  /** [s] of wall time that a transform is waited for: simulated time may stand still. */
  static constexpr double LONGEST_WAIT = 0.5;

  CloudFrames() : listener_(buffer_) {}

  /**
   * Pose of a frame in another at a time; of the latest time known if that is 0.
   * @throws InputError: none within LONGEST_WAIT, or one that is not finite
   */
  Pose poseOf(const std::string& frame, const std::string& in_frame, const ros::Time& time) const;
  /** Ends all waits. */
  void stop() { stopped_ = true; }

 private:
  std::atomic<bool> stopped_{false};
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

}  // namespace blem_sim::node
