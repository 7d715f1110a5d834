#include "clouds/live_clouds.h"

#include <blem_sim/LiveCloudUpdate.h>
#include <ros/console.h>
#include <boost/function.hpp>

#include "blem_sim/geometry/input_error.h"
#include "messages/conversions.h"

namespace blem_sim::node {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr int QUEUE_SIZE = 10;  // of messages, which a callback takes at once
constexpr int UPDATES_KEPT = 100;
constexpr std::chrono::seconds TELLING_PERIOD(1);  // of markers and the load report

template <typename Message>
ros::SubscribeOptions subscriptionTo(LiveCloud* cloud) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> receive = [cloud](const auto& message) { cloud->receive(message); };
  return checkedSubscription<Message>(cloud->topic(), QUEUE_SIZE, receive, [cloud](const std::string& why) { cloud->refuseUnread(why); });
}

ros::SubscribeOptions subscriptionOf(sim::LiveConfig::Type type, LiveCloud* cloud) {
  switch (type) {
    case sim::LiveConfig::Type::CLOUD:
      return subscriptionTo<sensor_msgs::PointCloud2>(cloud);
    case sim::LiveConfig::Type::MESH:
      return subscriptionTo<shape_msgs::Mesh>(cloud);
    case sim::LiveConfig::Type::GRID:
      return subscriptionTo<nav_msgs::OccupancyGrid>(cloud);
  }
  return {};
}

}  // namespace

LiveClouds::LiveClouds(const ros::NodeHandle& node, ros::NodeHandle private_node, SimulationLoop* loop)
    : loop_(*loop),
      time_(loop->simulator().time()),
      updates_(private_node.advertise<LiveCloudUpdate>("live_cloud_updates", UPDATES_KEPT, true)),
      receiver_(1, &callbacks_) {
  ros::NodeHandle receiving(node);
  receiving.setCallbackQueue(&callbacks_);
  for (const sim::EnvironmentConfig& environment : loop->simulator().config().environments) {
    if (environment.live.topic.empty()) continue;
    clouds_.push_back(std::make_unique<LiveCloud>(environment, frames_, time_));
    ros::SubscribeOptions options = subscriptionOf(environment.live.type, clouds_.back().get());
    subscribers_.push_back(receiving.subscribe(options));
  }
  loop->beforeSteps([this](bool wait) { takeUpdates(wait); });
  receiver_.start();
}

LiveClouds::~LiveClouds() {
  frames_.stop();
  receiver_.stop();
  subscribers_.clear();
}

void LiveClouds::timeRestarted() {
  time_ = loop_.simulator().time();
  for (const auto& cloud : clouds_) cloud->restart();
}

void LiveClouds::takeUpdates(bool wait) {
  if (wait) waitUntilBuilt();
  for (const auto& cloud : clouds_)
    if (std::optional<BuiltCloud> built = cloud->take(neighboursOf(*cloud))) exchange(cloud.get(), &*built);
  tellChanges();
}

LiveCloud::Neighbours LiveClouds::neighboursOf(const LiveCloud& cloud) const {
  return [&] { return loop_.simulator().cloudNeighbours(cloud.name()); };
}

void LiveClouds::waitUntilBuilt() {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(LONGEST_WAIT);
  for (const auto& cloud : clouds_)
    if (!cloud->waitUntilBuilt(deadline, neighboursOf(*cloud)))
      ROS_WARN("environments: %s: a cloud takes longer than %d s: the steps go on without it", cloud->name().c_str(), LONGEST_WAIT);
}

void LiveClouds::exchange(LiveCloud* cloud, BuiltCloud* built) {
  sim::Simulator& simulator = loop_.simulator();
  LiveCloudUpdate update;
  const geometry::MeshReport& report = built->surface.report;
  update.points = static_cast<std::uint32_t>(built->surface.isMesh() ? report.vertices : report.points);
  update.point_radius = built->surface.radius;
  try {
    simulator.updateCloud(cloud->name(), &built->surface, std::move(built->ahead));
  } catch (const InputError& error) {
    cloud->refuse(error.what());
    return;
  }
  cloud->giveBack(std::move(built->surface));
  cloud->countAccepted();
  const CloudCounts counts = cloud->counts();
  update.header.stamp = toStamp(simulator.time());
  update.header.frame_id = WORLD_FRAME;
  update.environment = cloud->name();
  update.step = simulator.steps();
  update.cloud_stamp = built->stamp;
  update.points_received = static_cast<std::uint32_t>(built->points_received);
  update.build_time = built->seconds;
  update.received = counts.received;
  update.accepted = counts.accepted;
  update.refused = counts.refused;
  update.overtaken = counts.overtaken;
  updates_.publish(update);
  ROS_DEBUG("environments: %s: cloud of %.3f s taken after step %lu, %u points", cloud->name().c_str(), built->stamp.toSec(),
            static_cast<unsigned long>(update.step), update.points);
  untold_ = true;
}

void LiveClouds::tellChanges() {
  const auto now = std::chrono::steady_clock::now();
  if (!untold_ || now < next_telling_) return;
  untold_ = false;
  next_telling_ = now + TELLING_PERIOD;
  loop_.cloudsChanged();
}

void LiveClouds::describe(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.summary(DiagnosticStatus::OK, "live clouds");
  for (const auto& cloud : clouds_) {
    const CloudCounts counts = cloud->counts();
    if (counts.accepted == 0)
      status.mergeSummary(DiagnosticStatus::WARN, cloud->name() + ": no cloud on " + cloud->topic() + " was taken yet");
    status.add(cloud->name() + " clouds received", counts.received);
    status.add(cloud->name() + " clouds accepted", counts.accepted);
    status.add(cloud->name() + " clouds refused", counts.refused);
    status.add(cloud->name() + " clouds overtaken by newer ones", counts.overtaken);
    status.add(cloud->name() + " last refusal", counts.last_refusal);
  }
}

}  // namespace blem_sim::node
