#include "clouds/cloud_frames.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>
#include <tuple>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {
namespace {

std::string withoutSlash(const std::string& frame) { return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame; }

}  // namespace

Pose CloudFrames::poseOf(const std::string& given, const std::string& in_frame, const ros::Time& time) const {
  const std::string frame = withoutSlash(given);
  if (frame.empty()) throw InputError("header.frame_id: is empty");
  if (frame == withoutSlash(in_frame)) return Pose::Identity();
  // Not by the buffer's own timeout: it goes by simulated time.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(LONGEST_WAIT);
  std::string why;
  while (!buffer_.canTransform(withoutSlash(in_frame), frame, time, ros::Duration(0), &why)) {
    if (stopped_ || std::chrono::steady_clock::now() > deadline)
      throw InputError(fmt::format("no transform from {} to {} at {:.3f} s: {}", frame, in_frame, time.toSec(), why));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    why.clear();
  }
  try {
    const geometry_msgs::TransformStamped found = buffer_.lookupTransform(withoutSlash(in_frame), frame, time);
    const auto& [t, q] = std::tie(found.transform.translation, found.transform.rotation);
    const Quaternion turn(q.w, q.x, q.y, q.z);
    const Vector3 way(t.x, t.y, t.z);
    if (!way.allFinite() || !(turn.norm() > 0) || !turn.coeffs().allFinite())
      throw InputError(fmt::format("the transform from {} to {} is not finite", frame, in_frame));
    Pose pose = Pose::Identity();
    pose.linear() = turn.normalized().toRotationMatrix();
    pose.translation() = way;
    return pose;
  } catch (const tf2::TransformException& error) {
    throw InputError(fmt::format("no transform from {} to {}: {}", frame, in_frame, error.what()));
  }
}

}  // namespace blem_sim::node
