#include "publishers/ranges/range_publisher.h"

#include <boost/make_shared.hpp>

#include <algorithm>
#include <utility>

#include "messages/conversions.h"
#include "messages/range_messages.h"
#include "sending/poll_rounds.h"

namespace blem_sim::node {

namespace {

// Megabytes each: more than a few are of no use to who is late.
constexpr int IMAGES = 5;
constexpr int SCANS = 100;

template <typename Message>
void send(const ListenedPublisher& publisher, Message message, const std_msgs::Header& header) {
  const auto shared = boost::make_shared<Message>(std::move(message));
  shared->header = header;
  const auto between = PollRounds::instance().betweenHandOvers();
  publisher.publish(shared);
}

}  // namespace

std::vector<std::string> rangeTopics(const std::string& topic, const sim::SensorConfig& sensor) {
  if (sensor.type != sim::SensorType::DEPTH_CAMERA) return {topic};
  const sim::CameraTopics& own = sensor.camera_topics;
  const auto below = [&](const std::string& own_topic, const char* name) {
    return own_topic.empty() ? topic + "/depth/" + name : own_topic;
  };
  return {below(own.camera_info, "camera_info"), below(own.image_raw, "image_raw"), below(own.image, "image"), below(own.points, "points")};
}

std::shared_ptr<const RangeTopics> advertiseRanges(ros::NodeHandle* node, const std::string& topic, const sim::SensorConfig& sensor) {
  const auto topics = std::make_shared<RangeTopics>();
  topics->config = sensor;
  std::vector<ListenedPublisher>& made = topics->publishers;
  const std::vector<std::string> names = rangeTopics(topic, sensor);
  if (sensor.type == sim::SensorType::DEPTH_CAMERA) {
    made.push_back(ListenedPublisher::advertise<sensor_msgs::CameraInfo>(node, names[0], SCANS));
    made.push_back(ListenedPublisher::advertise<sensor_msgs::Image>(node, names[1], IMAGES));
    made.push_back(ListenedPublisher::advertise<sensor_msgs::Image>(node, names[2], IMAGES));
    made.push_back(ListenedPublisher::advertise<sensor_msgs::PointCloud2>(node, names[3], IMAGES));
  } else if (sensor.rays.layers == 1) {
    made.push_back(ListenedPublisher::advertise<sensor_msgs::LaserScan>(node, names[0], SCANS));
  } else {
    made.push_back(ListenedPublisher::advertise<sensor_msgs::PointCloud2>(node, names[0], SCANS));
  }
  return topics;
}

void RangePublisher::publish(const std::shared_ptr<const RangeTopics>& topics, double time, const std::string& frame_id,
                             const std::shared_ptr<const sim::RangeView>& view) {
  const auto listened = [](const ListenedPublisher& publisher) { return publisher.listened(); };
  if (std::none_of(topics->publishers.begin(), topics->publishers.end(), listened)) return;
  Header header;
  header.stamp = toStamp(time);
  header.frame_id = frame_id;
  const auto draw = topics->config.type == sim::SensorType::DEPTH_CAMERA ? drawCamera : drawLidar;
  thread_.add([topics, view, header, draw] { draw(*topics, *view, header); });
}

void RangePublisher::drawCamera(const RangeTopics& topics, const sim::RangeView& view, const Header& header) {
  const ListenedPublisher &info = topics.publishers[0], &metres = topics.publishers[1], &millimetres = topics.publishers[2],
                          &points = topics.publishers[3];
  if (info.listened()) send(info, toCameraInfo(view.rays), header);
  if (!metres.listened() && !millimetres.listened() && !points.listened()) return;
  const std::vector<float> depths = sim::depthsOf(view);
  if (metres.listened()) send(metres, toMetreImage(view.rays, depths), header);
  if (millimetres.listened()) send(millimetres, toMillimetreImage(view.rays, depths), header);
  if (points.listened()) send(points, toCloud(view.rays, depths), header);
}

void RangePublisher::drawLidar(const RangeTopics& topics, const sim::RangeView& view, const Header& header) {
  const std::vector<float> ranges = sim::rangesOf(view);
  if (view.rays.layers == 1)
    send(topics.publishers[0], toScan(topics.config, ranges), header);
  else
    send(topics.publishers[0], toLayeredCloud(view.rays, ranges), header);
}

}  // namespace blem_sim::node
