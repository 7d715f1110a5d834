// Vocabulary of every room: vectors, poses and the few spatial types. SI units.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace blem_sim {

using Vector3 = Eigen::Vector3d;
using Vector3i = Eigen::Vector3i;
using Matrix3 = Eigen::Matrix3d;
using Quaternion = Eigen::Quaterniond;

/** Rigid transform. X_AB maps coordinates in frame B to coordinates in frame A. */
using Pose = Eigen::Isometry3d;

/** Axis-aligned box; empty until extended. */
using Box = Eigen::AlignedBox3d;

/** Force [N] and torque [N m]; the frame and the reference point are in the variable's name or comment. */
struct Wrench {
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();
};

/** Pose from a translation [m] and fixed-axis roll, pitch, yaw [rad], the URDF convention Rz(yaw) Ry(pitch) Rx(roll). */
inline Pose makePose(const Vector3& xyz, const Vector3& rpy = Vector3::Zero()) {
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(rpy.z(), Vector3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vector3::UnitY()) *
                   Eigen::AngleAxisd(rpy.x(), Vector3::UnitX()))
                      .toRotationMatrix();
  pose.translation() = xyz;
  return pose;
}

}  // namespace blem_sim
