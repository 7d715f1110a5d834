#include "wheels/steered_wheels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/input_error.h"
#include "wheels/wheel_measures.h"

namespace blem_sim::sim {
namespace {

constexpr double STEEPEST = 1.5;             // [rad] in the middle, where rear wheels push
constexpr double SQUARE = 1e-9;              // [rad] off a right angle, up to which a wheel is square to the base
constexpr double SHORTEST_WHEELBASE = 1e-3;  // [m] of wheelbases
constexpr double SINGULAR = 1e-12;           // [m^2] of normal equations

[[noreturn]] void refuseCar(const ControllerConfig& config, const std::string& why) {
  throw InputError(fmt::format("controller '{}': {}", config.name, why));
}

std::size_t orderOf(const std::string& name, const std::vector<std::string>& names) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

SteeredWheels::SteeredWheels(const ControllerConfig& config, const model::RobotModel& robot)
    : takes_angles_(config.drive.steering.takes_angles) {
  const SteeringConfig& steering = config.drive.steering;
  wheels_ = steering.driven;
  steering_ = steering.joints;
  steering_at_ = orderOf(steering_.front(), config.joints);
  for (const std::string& wheel : steering.rear) middle_ += placeInBase(wheel, config, robot);
  middle_ /= static_cast<double>(steering.rear.size());
  addWheels(config, robot);
  addPins(config, robot);
  boundAngle(config, robot);
}

void SteeredWheels::addWheels(const ControllerConfig& config, const model::RobotModel& robot) {
  const SteeringConfig& steering = config.drive.steering;
  for (const std::string& wheel : steering.rear) addWheel(wheel, config, robot);
  for (const std::string& wheel : wheels_) {
    const std::size_t rear = orderOf(wheel, steering.rear);
    const bool is_rear = rear < steering.rear.size();
    driven_.push_back(is_rear ? rear : rolling_.size());
    if (!is_rear) addWheel(wheel, config, robot);
  }
  pulls_ = std::all_of(driven_.begin(), driven_.end(), [&](std::size_t wheel) { return rolling_[wheel].pin >= 0; });
}

void SteeredWheels::addWheel(const std::string& name, const ControllerConfig& config, const model::RobotModel& robot) {
  const SteeringConfig& steering = config.drive.steering;
  const bool is_rear = orderOf(name, steering.rear) < steering.rear.size();
  Wheel wheel;
  wheel.joint = orderOf(name, config.joints);
  wheel.pin = steeringAbove(robot.jointIndex(name), steering, robot);
  if (is_rear != (wheel.pin < 0))
    refuseCar(config, is_rear ? fmt::format("rear_wheel: '{}' hangs on a joint of front_steer; name wheels that are not steered", name)
                              : fmt::format("driven_wheel: '{}' is neither a rear_wheel nor does it hang on a joint of front_steer", name));
  const Eigen::Vector2d from = is_rear ? middle_ : placeInBase(steering_[wheel.pin], config, robot);
  wheel.y = placeInBase(name, config, robot).y() - from.y();
  wheel.radius = is_rear ? config.drive.wheel_radius : steering.steered_radius;
  rolling_.push_back(wheel);
}

void SteeredWheels::addPins(const ControllerConfig& config, const model::RobotModel& robot) {
  const SteeringConfig& steering = config.drive.steering;
  for (const std::string& joint : steering_) {
    const Eigen::Vector2d place = placeInBase(joint, config, robot) - middle_;
    pins_.push_back({place.x(), place.y()});
    wheelbase_ += place.x() / static_cast<double>(steering_.size());
  }
  if (steering.wheelbase > 0) {
    wheelbase_ = std::copysign(steering.wheelbase, wheelbase_);
    for (Pin& pin : pins_) pin.x = wheelbase_;
  }
  if (!(std::abs(wheelbase_) > SHORTEST_WHEELBASE))
    refuseCar(config, "wheel_separation_h: is missing, and the URDF has front_steer beside rear_wheel; give it in metres");
  wheelbase_ *= steering.wheelbase_multiplier;
  for (Pin& pin : pins_) pin.x *= steering.wheelbase_multiplier;
}

void SteeredWheels::boundAngle(const ControllerConfig& config, const model::RobotModel& robot) {
  const double given = config.drive.steering.max_angle, steepest = pulls_ ? M_PI / 2 : STEEPEST;
  most_ = given > 0 ? std::min(given, steepest) : steepest;
  least_ = -most_;
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    const model::JointModel& joint = robot.joints[robot.jointIndex(steering_[i])];
    if (joint.type != model::JointType::REVOLUTE) continue;
    least_ = std::max(least_, middleAngle(pins_[i], std::max(joint.limits.lower, -M_PI / 2)));
    most_ = std::min(most_, middleAngle(pins_[i], std::min(joint.limits.upper, M_PI / 2)));
  }
  if (!(least_ <= most_)) refuseCar(config, "front_steer: limits of its joints leave no angle; correct the URDF");
}

double SteeredWheels::middleAngle(const Pin& pin, double position) const {
  const double sine = std::sin(position), cosine = std::cos(position);
  return std::atan2(sine, (pin.x * cosine + pin.y * sine) / wheelbase_);
}

double SteeredWheels::positionOf(const Pin& pin, double angle) const {
  const double per_metre = std::sin(angle) / wheelbase_;
  return std::atan2(per_metre * pin.x, std::cos(angle) - per_metre * pin.y);
}

/** The way that a wheel stands ahead of its pin adds nothing to how it rolls. */
DriveTwist SteeredWheels::rollingRates(const Wheel& wheel, double position) const {
  if (wheel.pin < 0) return {1, -wheel.y};
  const Pin& pin = pins_[wheel.pin];
  const double sine = std::sin(position), cosine = std::cos(position);
  return {cosine, sine * pin.x - cosine * pin.y - wheel.y};
}

double SteeredWheels::angleFor(const DriveTwist& wanted, double now) const {
  if (takes_angles_) return std::clamp(wanted.angular, least_, most_);
  if (wanted.linear == 0 && wanted.angular == 0) return std::clamp(now, least_, most_);
  const double across = wanted.angular * wheelbase_;
  return std::clamp(std::atan2(wanted.linear < 0 ? -across : across, std::abs(wanted.linear)), least_, most_);
}

double SteeredWheels::speedFor(const DriveTwist& twist, const Steering& steering) const {
  if (!pulls_) return twist.linear / std::cos(steering.now);
  if (takes_angles_) return twist.linear;
  // The middle wheel's speed is the part of its wanted velocity along itself, so that it does not run away while it is turned.
  const bool is_square = M_PI / 2 - std::abs(steering.wanted) < SQUARE;
  const double across = is_square ? twist.angular * wheelbase_ : twist.linear * std::tan(steering.wanted);
  return twist.linear * std::cos(steering.now) + across * std::sin(steering.now);
}

std::vector<double> SteeredWheels::velocities(const DriveTwist& twist, const Steering& steering) const {
  const double speed = speedFor(twist, steering), ahead = std::cos(steering.now), turn = std::sin(steering.now) / wheelbase_;
  std::vector<double> velocities;
  for (const std::size_t index : driven_) {
    const Wheel& wheel = rolling_[index];
    const DriveTwist rates = rollingRates(wheel, wheel.pin < 0 ? 0 : positionOf(pins_[wheel.pin], steering.now));
    velocities.push_back(speed * (rates.linear * ahead + rates.angular * turn) / wheel.radius);
  }
  return velocities;
}

std::vector<double> SteeredWheels::positions(double angle) const {
  std::vector<double> positions;
  for (const Pin& pin : pins_) positions.push_back(positionOf(pin, angle));
  return positions;
}

double SteeredWheels::angleOf(const std::vector<dynamics::JointState>& joints) const {
  double sum = 0;
  for (std::size_t i = 0; i < pins_.size(); ++i) sum += middleAngle(pins_[i], joints[steering_at_ + i].position);
  return std::clamp(sum / static_cast<double>(pins_.size()), least_, most_);
}

/** The twist that least squares give, of rims that roll and of steered wheels that do not slip sideways. */
DriveTwist SteeredWheels::rolled(const std::vector<dynamics::JointState>& joints) const {
  double vv = 0, vw = 0, ww = 0, v = 0, w = 0;  // normal equations
  const auto add = [&](const DriveTwist& rates, double speed) {
    vv += rates.linear * rates.linear;
    vw += rates.linear * rates.angular;
    ww += rates.angular * rates.angular;
    v += rates.linear * speed;
    w += rates.angular * speed;
  };
  for (const Wheel& wheel : rolling_) {
    const double position = wheel.pin < 0 ? 0 : joints[steering_at_ + wheel.pin].position;
    add(rollingRates(wheel, position), wheel.radius * joints[wheel.joint].velocity);
  }
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    const double position = joints[steering_at_ + i].position, sine = std::sin(position), cosine = std::cos(position);
    add({-sine, pins_[i].x * cosine + pins_[i].y * sine}, 0);
  }
  const double determinant = vv * ww - vw * vw;
  if (!(determinant > SINGULAR)) return {v / std::max(vv, SINGULAR), 0};
  return {(ww * v - vw * w) / determinant, (vv * w - vw * v) / determinant};
}

}  // namespace blem_sim::sim
