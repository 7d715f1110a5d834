#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include <memory>
#include <string>
#include <vector>

#include "blem_sim/sim/range_view.h"
#include "blem_sim/sim/simulator_types.h"
#include "sending/drawing_thread.h"
#include "sending/listened_publisher.h"

namespace blem_sim::node {

/** Topics of one camera or lidar. */
struct RangeTopics {
  sim::SensorConfig config;
  std::vector<ListenedPublisher> publishers;  ///< of a camera: info, metres, millimetres, points
};

/** Names of the topics of a camera (in the order of its publishers) or a lidar. @param topic of the sensor */
std::vector<std::string> rangeTopics(const std::string& topic, const sim::SensorConfig& sensor);

/** Advertises rangeTopics(): a camera's depth/camera_info, image_raw, image and points below its topic, a lidar's one message at it. */
std::shared_ptr<const RangeTopics> advertiseRanges(ros::NodeHandle* node, const std::string& topic, const sim::SensorConfig& sensor);

/**
 * Depth cameras (depth/camera_info, image_raw, image and points below their topic) and lidars (LaserScan, of several layers PointCloud2).
 * Views are drawn in a thread beside the steps, and only those that somebody listens to.
 */
class RangePublisher {
 public:
  /** @param time [s] simulated, of the view */
  void publish(const std::shared_ptr<const RangeTopics>& topics, double time, const std::string& frame_id,
               const std::shared_ptr<const sim::RangeView>& view);
  /** Returns when all messages are published. */
  void drain() { thread_.drain(); }

 private:
  using Header = std_msgs::Header;
  static void drawCamera(const RangeTopics& topics, const sim::RangeView& view, const Header& header);
  static void drawLidar(const RangeTopics& topics, const sim::RangeView& view, const Header& header);

  DrawingThread thread_;
};

}  // namespace blem_sim::node
