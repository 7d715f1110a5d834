#include "clouds/live_cloud.h"

#include <ros/console.h>

#include <utility>

namespace blem_sim::node {
namespace {

constexpr std::chrono::seconds WARNING_PERIOD(5);
constexpr std::chrono::milliseconds LONGEST_ASKING(20);  // beyond, steps are paused or slow, and need no search ahead

}  // namespace

LiveCloud::LiveCloud(const sim::EnvironmentConfig& config, const CloudFrames& frames, const std::atomic<double>& time)
    : name_(config.name), topic_(config.live.topic), builder_(config, frames, time), thread_([this] { run(); }) {}

LiveCloud::~LiveCloud() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LiveCloud::receive(const LiveMessage& message) {
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

void LiveCloud::answer(const Neighbours& neighbours) {
  if (!std::exchange(asks_, false)) return;
  neighbours_ = neighbours();
  changed_.notify_all();
}

std::optional<BuiltCloud> LiveCloud::take(const Neighbours& neighbours) {
  const std::lock_guard<std::mutex> lock(mutex_);
  answer(neighbours);
  return std::exchange(ready_, std::nullopt);
}

void LiveCloud::giveBack(sim::CloudSurface surface) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    to_free_.push_back(std::move(surface));
  }
  changed_.notify_all();
}

bool LiveCloud::waitUntilBuilt(std::chrono::steady_clock::time_point deadline, const Neighbours& neighbours) {
  std::unique_lock<std::mutex> lock(mutex_);
  return changed_.wait_until(lock, deadline, [&] {
    answer(neighbours);
    return !waiting_ && !busy_;
  });
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
  if (tell) ROS_WARN("environments: %s: a message on %s is refused: %s", name().c_str(), topic().c_str(), why.c_str());
}

void LiveCloud::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || waiting_ || !to_free_.empty(); });
    if (ends_) return;
    std::vector<sim::CloudSurface> old = std::exchange(to_free_, {});
    const std::optional<LiveMessage> message = std::exchange(waiting_, std::nullopt);
    if (std::exchange(restarts_, false)) builder_.restart();
    busy_ = message.has_value();
    lock.unlock();
    old.clear();
    if (message) work(*message);
    lock.lock();
    busy_ = false;
    changed_.notify_all();
  }
}

void LiveCloud::work(const LiveMessage& message) {
  std::optional<BuiltCloud> built;
  try {
    const auto start = std::chrono::steady_clock::now();
    built = std::visit([this](const auto& given) { return builder_.build(*given); }, message);
    built->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    searchAhead(&*built);
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
  // Freed after the lock: what was ready before.
  const std::lock_guard<std::mutex> lock(mutex_);
  std::swap(ready_, built);
  counts_.overtaken += built ? 1 : 0;
}

void LiveCloud::searchAhead(BuiltCloud* built) {
  std::unique_lock<std::mutex> lock(mutex_);
  asks_ = true;
  changed_.notify_all();
  changed_.wait_for(lock, LONGEST_ASKING, [this] { return ends_ || neighbours_; });
  asks_ = false;
  const std::optional<sim::CloudNeighbours> neighbours = std::exchange(neighbours_, std::nullopt);
  lock.unlock();
  if (neighbours) built->ahead = sim::searchAhead(*neighbours, built->surface);
}

}  // namespace blem_sim::node
