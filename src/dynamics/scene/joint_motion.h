// Motion of a joint's child.
#pragma once

#include "blem_sim/dynamics/world_types.h"

namespace blem_sim::dynamics {

/** Pose of the child in the joint frame at a position, against position 0. */
inline Pose jointMotion(JointKind kind, const Vector3& axis, double position) {
  Pose X = Pose::Identity();
  if (kind == JointKind::REVOLUTE) X.linear() = Eigen::AngleAxisd(position, axis).toRotationMatrix();
  if (kind == JointKind::PRISMATIC) X.translation() = position * axis;
  return X;
}

}  // namespace blem_sim::dynamics
