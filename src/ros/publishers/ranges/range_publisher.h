#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "blem_sim/sim/range_view.h"
#include "blem_sim/sim/simulator_types.h"
#include "sending/drawing_thread.h"
#include "sending/listened_publisher.h"

namespace blem_sim {

/**
 * Depth cameras (depth/camera_info, image_raw, image and points below their topic) and lidars (LaserScan, of several layers PointCloud2).
 * Views are drawn in a thread beside the steps, and only those that somebody listens to.
 */
class RangePublisher {
 public:
  /** @param sensor index into Simulator::sensors() */
  void advertise(ros::NodeHandle* node, const std::string& topic, int sensor, const SensorInfo& info);
  /** @param time [s] simulated, of the view */
  void publish(int sensor, double time, const std::string& frame_id, const std::shared_ptr<const RangeView>& view);
  /** Returns when all messages are published. */
  void drain() { thread_.drain(); }

 private:
  struct Topics {
    SensorConfig config;
    std::vector<ListenedPublisher> publishers;  // of a camera: info, metres, millimetres, points
  };
  using Header = std_msgs::Header;
  static void drawCamera(const Topics& topics, const RangeView& view, const Header& header);
  static void drawLidar(const Topics& topics, const RangeView& view, const Header& header);

  std::map<int, Topics> topics_;  // by sensor
  DrawingThread thread_;          // last: it uses the others
};

}  // namespace blem_sim
