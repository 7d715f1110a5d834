#include "clouds/live_cloud.h"

#include <fmt/format.h>
#include <ros/console.h>

#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "clouds/cloud_message.h"

namespace blem_sim::node {
namespace {

constexpr std::chrono::seconds WARNING_PERIOD(5);

model::CloudOptions withoutFilters(model::CloudOptions options) {
  options.filters.clear();
  return options;
}

}  // namespace

LiveCloud::LiveCloud(const sim::EnvironmentConfig& config, const CloudFrames& frames, const std::atomic<double>& time)
    : config_(config), frames_(frames), time_(time), map_(config.live.map), surface_options_(withoutFilters(config.cloud)), thread_([this] {
        run();
      }) {}

LiveCloud::~LiveCloud() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LiveCloud::receive(const sensor_msgs::PointCloud2ConstPtr& message) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.received;
    counts_.overtaken += waiting_ ? 1 : 0;
    waiting_ = message;
  }
  changed_.notify_all();
}

void LiveCloud::refuseUnread(const std::string& why) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.received;
  }
  refuse(why);
}

std::optional<BuiltCloud> LiveCloud::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(ready_, std::nullopt);
}

void LiveCloud::giveBack(sim::CloudSurface surface) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    to_free_.push_back(std::move(surface));
  }
  changed_.notify_all();
}

bool LiveCloud::waitUntilBuilt(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock<std::mutex> lock(mutex_);
  return changed_.wait_until(lock, deadline, [this] { return !waiting_ && !busy_; });
}

void LiveCloud::restart() {
  const std::lock_guard<std::mutex> lock(mutex_);
  restarts_ = true;
}

CloudCounts LiveCloud::counts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counts_;
}

void LiveCloud::countAccepted() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counts_.accepted;
}

void LiveCloud::refuse(const std::string& why) {
  const auto now = std::chrono::steady_clock::now();  // simulated time may stand still
  bool tell = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.refused;
    counts_.last_refusal = why;
    tell = now >= next_warning_;
    if (tell) next_warning_ = now + WARNING_PERIOD;
  }
  if (tell) ROS_WARN("environments: %s: a cloud on %s is refused: %s", name().c_str(), topic().c_str(), why.c_str());
}

void LiveCloud::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || waiting_ || !to_free_.empty(); });
    if (ends_) return;
    std::vector<sim::CloudSurface> old = std::exchange(to_free_, {});
    const sensor_msgs::PointCloud2ConstPtr message = std::exchange(waiting_, nullptr);
    if (std::exchange(restarts_, false)) map_.clear();
    busy_ = message != nullptr;
    lock.unlock();
    old.clear();
    if (message) work(*message);
    lock.lock();
    busy_ = false;
    changed_.notify_all();
  }
}

void LiveCloud::work(const sensor_msgs::PointCloud2& message) {
  std::optional<BuiltCloud> built;
  try {
    built = build(message);
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
  // Freed after the lock: what was ready before.
  const std::lock_guard<std::mutex> lock(mutex_);
  std::swap(ready_, built);
  counts_.overtaken += built ? 1 : 0;
}

void LiveCloud::checkStamp(const ros::Time& stamp) const {
  if (stamp.toSec() > time_ + MOST_AHEAD)
    throw InputError(fmt::format("header.stamp: {:.3f} s lies in the future of simulated time, {:.3f} s", stamp.toSec(), time_.load()));
}

BuiltCloud LiveCloud::build(const sensor_msgs::PointCloud2& message) {
  const auto start = std::chrono::steady_clock::now();
  checkStamp(message.header.stamp);
  std::vector<Vector3> points = pointsOf(message);
  const Pose X_WC = frames_.poseOf(message.header.frame_id, config_.live.frame, message.header.stamp);
  for (Vector3& p : points) p = X_WC * p;
  BuiltCloud built;
  built.stamp = message.header.stamp;
  built.points_received = points.size();
  std::vector<std::string> notes;
  points = model::filtered(std::move(points), config_.cloud.filters, "cloud", &notes);
  if (config_.live.update == sim::LiveConfig::Update::ACCUMULATE) {
    map_.add(points, message.header.stamp.isZero() ? time_.load() : message.header.stamp.toSec());
    points = map_.points();
  }
  if (points.empty()) throw InputError("filters and the map left no point");
  built.surface = sim::makeCloudSurface(std::move(points), surface_options_, topic());
  built.surface.report.notes.insert(built.surface.report.notes.begin(), notes.begin(), notes.end());
  // The first cloud's radius stays: one that changed from cloud to cloud would lift and lower what stands there.
  surface_options_.auto_radius = false;
  surface_options_.point_radius = built.surface.radius;
  built.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return built;
}

}  // namespace blem_sim::node
