// One live environment: from messages to surfaces, beside the steps.
#pragma once

#include <ros/subscriber.h>
#include <sensor_msgs/PointCloud2.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "blem_sim/model/voxel_map.h"
#include "blem_sim/sim/simulator_types.h"
#include "clouds/cloud_frames.h"

namespace blem_sim::node {

/** A cloud that is ready for contact. */
struct BuiltCloud {
  sim::CloudSurface surface;
  ros::Time stamp;  ///< of its message
  std::size_t points_received = 0;
  double seconds = 0;  ///< of wall time that it took
};

/** Messages of a live environment since the start. */
struct CloudCounts {
  std::uint64_t received = 0, accepted = 0, refused = 0, overtaken = 0;
  std::string last_refusal;
};

/**
 * Takes the messages of a topic and builds surfaces of them in a thread of its own. At most one message waits and at most one surface is
 * ready: a newer one overtakes it. All functions may be called by any thread.
 */
class LiveCloud {
 public:
  /** [s] by which a stamp may be ahead of simulated time. */
  static constexpr double MOST_AHEAD = 0.5;

  /** @param frames, time [s] simulated: must outlive this */
  LiveCloud(const sim::EnvironmentConfig& config, const CloudFrames& frames, const std::atomic<double>& time);
  ~LiveCloud();
  LiveCloud(const LiveCloud&) = delete;
  LiveCloud& operator=(const LiveCloud&) = delete;

  const std::string& name() const { return config_.name; }
  const std::string& topic() const { return config_.live.topic; }
  /** Counts a message that is none. */
  void refuseUnread(const std::string& why);
  void receive(const sensor_msgs::PointCloud2ConstPtr& message);
  /** The newest surface that is ready, once. */
  std::optional<BuiltCloud> take();
  /** Frees a surface in this object's thread. */
  void giveBack(sim::CloudSurface surface);
  /** Returns when all messages received so far are built or refused. False if the deadline came first. */
  bool waitUntilBuilt(std::chrono::steady_clock::time_point deadline);
  /** Forgets the map, with the next message: time has started again. */
  void restart();
  CloudCounts counts() const;
  void countAccepted();
  /** Counts a message that is of no use; the log tells it now and then. */
  void refuse(const std::string& why);

 private:
  void run();
  /** Makes the message's surface ready, or refuses it. */
  void work(const sensor_msgs::PointCloud2& message);
  BuiltCloud build(const sensor_msgs::PointCloud2& message);
  void checkStamp(const ros::Time& stamp) const;

  sim::EnvironmentConfig config_;
  const CloudFrames& frames_;
  const std::atomic<double>& time_;
  model::VoxelMap map_;  // of the thread, like the next one
  model::CloudOptions surface_options_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  sensor_msgs::PointCloud2ConstPtr waiting_;  // guarded by the mutex, like all that follow
  std::optional<BuiltCloud> ready_;
  std::vector<sim::CloudSurface> to_free_;
  CloudCounts counts_;
  std::chrono::steady_clock::time_point next_warning_;
  bool busy_ = false, ends_ = false, restarts_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace blem_sim::node
