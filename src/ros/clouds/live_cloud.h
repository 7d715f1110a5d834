// One live environment: from messages to surfaces, beside the steps.
#pragma once

#include <ros/subscriber.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "clouds/surface_builder.h"

namespace blem_sim::node {

/** Message of a live environment. */
using LiveMessage = std::variant<sensor_msgs::PointCloud2ConstPtr, shape_msgs::MeshConstPtr, nav_msgs::OccupancyGridConstPtr>;

/** Messages of a live environment since the start. */
struct CloudCounts {
  std::uint64_t received = 0, accepted = 0, refused = 0, overtaken = 0;
  std::string last_refusal;
};

/**
 * Takes the messages of a topic and builds surfaces of them in a thread of its own, which searches for their contacts ahead. At most one
 * message waits and at most one surface is ready: a newer one overtakes it. All functions may be called by any thread.
 */
class LiveCloud {
 public:
  /** @param frames, time [s] simulated: must outlive this */
  LiveCloud(const sim::EnvironmentConfig& config, const CloudFrames& frames, const std::atomic<double>& time);
  ~LiveCloud();
  LiveCloud(const LiveCloud&) = delete;
  LiveCloud& operator=(const LiveCloud&) = delete;

  const std::string& name() const { return name_; }
  const std::string& topic() const { return topic_; }
  /** Counts a message that is none. */
  void refuseUnread(const std::string& why);
  void receive(const LiveMessage& message);
  using Neighbours = std::function<sim::CloudNeighbours()>;  ///< what the surface may touch, asked for in the caller's thread

  /** The newest surface that is ready, once. */
  std::optional<BuiltCloud> take(const Neighbours& neighbours);
  /** Frees a surface in this object's thread. */
  void giveBack(sim::CloudSurface surface);
  /** Returns when all messages received so far are built or refused. False if the deadline came first. */
  bool waitUntilBuilt(std::chrono::steady_clock::time_point deadline, const Neighbours& neighbours);
  /** Forgets the map, with the next message: time has started again. */
  void restart();
  CloudCounts counts() const;
  void countAccepted();
  /** Counts a message that is of no use; the log tells it now and then. */
  void refuse(const std::string& why);

 private:
  void run();
  /** Makes the message's surface ready, or refuses it. */
  void work(const LiveMessage& message);
  /** Searches for the surface's contacts, if a step tells soon where things are. */
  void searchAhead(BuiltCloud* built);
  /** Tells the thread where things are, if it asks. Precondition: the mutex is locked. */
  void answer(const Neighbours& neighbours);

  const std::string name_, topic_;
  SurfaceBuilder builder_;  // of the thread
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<LiveMessage> waiting_;  // guarded by the mutex, like all that follow
  std::optional<BuiltCloud> ready_;
  std::optional<sim::CloudNeighbours> neighbours_;
  std::vector<sim::CloudSurface> to_free_;
  CloudCounts counts_;
  std::chrono::steady_clock::time_point next_warning_;
  bool busy_ = false, asks_ = false, ends_ = false, restarts_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace blem_sim::node
