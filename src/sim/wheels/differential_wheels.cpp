#include "wheels/differential_wheels.h"

namespace blem_sim::sim {
namespace {

/** [m/s] of the rims of some wheels, their mean. */
double rimSpeed(const dynamics::JointState* wheels, std::size_t count, double radius) {
  double sum = 0;
  for (std::size_t wheel = 0; wheel < count; ++wheel) sum += wheels[wheel].velocity;
  return radius * sum / static_cast<double>(count);
}

}  // namespace

DifferentialWheels::DifferentialWheels(const DriveConfig& config)
    : left_(config.left.size()), right_(config.right.size()), separation_(config.wheel_separation), radius_(config.wheel_radius) {
  wheels_ = config.left;
  wheels_.insert(wheels_.end(), config.right.begin(), config.right.end());
}

std::vector<double> DifferentialWheels::velocities(const DriveTwist& twist, const Steering&) const {
  const double aside = twist.angular * separation_ / 2;
  std::vector<double> velocities(left_, (twist.linear - aside) / radius_);
  velocities.resize(left_ + right_, (twist.linear + aside) / radius_);
  return velocities;
}

DriveTwist DifferentialWheels::rolled(const std::vector<dynamics::JointState>& joints) const {
  const double left = rimSpeed(joints.data(), left_, radius_), right = rimSpeed(joints.data() + left_, right_, radius_);
  return {(left + right) / 2, (right - left) / separation_};
}

}  // namespace blem_sim::sim
