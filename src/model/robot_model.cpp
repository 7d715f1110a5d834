#include "blem_sim/model/robot_model.h"

#include <algorithm>

namespace blem_sim::model {
namespace {

template <typename Named>
int indexOf(const std::vector<Named>& items, const std::string& name) {
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items[i].name == name) return static_cast<int>(i);
  return -1;
}

}  // namespace

int RobotModel::linkIndex(const std::string& link) const { return indexOf(links, link); }

int RobotModel::jointIndex(const std::string& joint) const { return indexOf(joints, joint); }

const Transmission* RobotModel::transmissionOf(const std::string& joint) const {
  const auto drives = [&](const Transmission& transmission) { return transmission.joint == joint; };
  const auto found = std::find_if(transmissions.begin(), transmissions.end(), drives);
  return found == transmissions.end() ? nullptr : &*found;
}

Pose LumpedJoint::pose(double q) const {
  switch (type) {
    case JointType::REVOLUTE:
    case JointType::CONTINUOUS:
      return X_PJ * Pose(Eigen::AngleAxisd(q, axis));
    case JointType::PRISMATIC:
      return X_PJ * Pose(Eigen::Translation3d(q * axis));
    default:
      return X_PJ;
  }
}

double LumpedRobot::mass() const {
  double sum = 0;
  for (const LumpedBody& body : bodies) sum += body.inertial.mass;
  return sum;
}

}  // namespace blem_sim::model
