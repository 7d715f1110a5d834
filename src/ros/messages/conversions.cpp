#include "messages/conversions.h"

#include <cmath>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {

const char* const WORLD_FRAME = "world";

ros::Time toStamp(double seconds) {
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(std::llround(seconds * 1e9)));
  return stamp;
}

geometry_msgs::Vector3 toVector3(const Vector3& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

geometry_msgs::Point toPoint(const Vector3& p) {
  geometry_msgs::Point message;
  message.x = p.x();
  message.y = p.y();
  message.z = p.z();
  return message;
}

geometry_msgs::Quaternion toQuaternion(const Quaternion& q) {
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

geometry_msgs::Pose toPose(const Pose& X) {
  geometry_msgs::Pose message;
  message.position = toPoint(X.translation());
  message.orientation = toQuaternion(Quaternion(X.linear()).normalized());
  return message;
}

geometry_msgs::Transform toTransform(const Pose& X) {
  geometry_msgs::Transform message;
  message.translation = toVector3(X.translation());
  message.rotation = toQuaternion(Quaternion(X.linear()).normalized());
  return message;
}

geometry_msgs::Wrench toWrench(const Vector3& force, const Vector3& torque) {
  geometry_msgs::Wrench message;
  message.force = toVector3(force);
  message.torque = toVector3(torque);
  return message;
}

std_msgs::ColorRGBA toColour(const sim::Colour& colour) {
  std_msgs::ColorRGBA message;
  message.r = colour.r;
  message.g = colour.g;
  message.b = colour.b;
  message.a = 1;
  return message;
}

geometry_msgs::Twist toTwist(const Vector3& linear, const Vector3& angular) {
  geometry_msgs::Twist message;
  message.linear = toVector3(linear);
  message.angular = toVector3(angular);
  return message;
}

Vector3 fromVector3(const geometry_msgs::Vector3& message) { return {message.x, message.y, message.z}; }
Vector3 fromPoint(const geometry_msgs::Point& message) { return {message.x, message.y, message.z}; }

Pose fromPose(const geometry_msgs::Pose& message, const std::string& source) {
  const Vector3 translation(message.position.x, message.position.y, message.position.z);
  Quaternion rotation(message.orientation.w, message.orientation.x, message.orientation.y, message.orientation.z);
  if (!translation.allFinite() || !rotation.coeffs().allFinite()) {
    throw InputError(source + ": pose: a coordinate is NaN or infinite; give finite numbers");
  }
  if (rotation.norm() == 0) rotation = Quaternion::Identity();
  Pose X = Pose::Identity();
  X.linear() = rotation.normalized().toRotationMatrix();
  X.translation() = translation;
  return X;
}

}  // namespace blem_sim::node
