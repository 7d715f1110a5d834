#include "blem_sim/sim/drive_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/link_motion.h"
#include "controllers/controlled_joints.h"

namespace blem_sim::sim {
namespace {

constexpr double SAME_AGE = 1e-9;     // [s] rounding of times that are sums of steps
constexpr double SMALL_ANGLE = 1e-4;  // [rad] up to which two terms of the sine's series are exact

/** sin(x) / x */
double sinc(double x) { return std::abs(x) < SMALL_ANGLE ? 1 - x * x / 6 : std::sin(x) / x; }

std::vector<int> wheelsOf(const RobotInfo& robot, const ControllerConfig& config) {
  const DriveConfig& drive = config.drive;
  if (drive.left.empty() || drive.right.empty() || !(drive.wheel_separation > 0) || !(drive.wheel_radius > 0))
    throw InputError(fmt::format("controller '{}': needs left_wheel, right_wheel, wheel_separation and wheel_radius", config.name));
  for (const std::string& wheel : config.joints)
    if (std::count(config.joints.begin(), config.joints.end(), wheel) > 1)
      throw InputError(fmt::format("controller '{}': wheel '{}' is there twice; name it once, left or right", config.name, wheel));
  return controlledJoints(robot, config);
}

}  // namespace

DriveController::DriveController(Simulator* simulator, int robot, ControllerConfig config)
    : simulator_(simulator),
      robot_(simulator->robots().at(robot).name),
      config_(std::move(config)),
      joints_(wheelsOf(simulator->robots().at(robot), config_)) {
  const model::RobotModel& model = *simulator->robots()[robot].description;
  const int link = model.linkIndex(config_.drive.base_frame);
  base_ = link < 0 ? model.root : link;
}

int DriveController::robot() const { return controlledRobot(*simulator_, config_, robot_); }

void DriveController::start() {
  running_ = true;
  restart();
}

void DriveController::stop() {
  if (running_) drive({});
  running_ = false;
}

void DriveController::restart() {
  x_ = y_ = heading_ = 0;
  steps_ = simulator_->steps();
  drive({});
}

void DriveController::command(const DriveTwist& twist) {
  if (!running_) throw InputError(fmt::format("controller '{}' is stopped; start it by switch_controller", config_.name));
  for (const auto& [field, number] : {std::make_pair("linear.x", twist.linear), std::make_pair("angular.z", twist.angular)})
    if (!isCommand(number))
      throw InputError(fmt::format("twist: {}: is {}; give a finite number within {:g}", field, number, LARGEST_COMMAND));
  drive(twist);
  command_time_ = simulator_->time();
}

void DriveController::drive(const DriveTwist& twist) {
  const DriveConfig& settings = config_.drive;
  const double aside = twist.angular * settings.wheel_separation / 2;
  JointVelocityCommand command;
  command.joints = config_.joints;
  command.velocities.assign(settings.left.size(), (twist.linear - aside) / settings.wheel_radius);
  command.velocities.resize(command.joints.size(), (twist.linear + aside) / settings.wheel_radius);
  command.acceleration = settings.wheel_acceleration / settings.wheel_radius;
  command.max_effort = settings.wheel_torque;
  simulator_->driveJoints(robot(), command);
  twist_ = twist;
}

void DriveController::update() {
  const bool is_next = simulator_->steps() == steps_ + 1;
  steps_ = simulator_->steps();
  if (!running_) return;
  if (isTakenOver()) return restart();
  // A state that is restored sets wheels to where they have not rolled to.
  if (is_next) roll(simulator_->config().time_step);
  const double now = simulator_->time(), timeout = config_.drive.cmd_vel_timeout;
  command_time_ = std::min(command_time_, now);
  const bool moves = twist_.linear != 0 || twist_.angular != 0;
  if (timeout > 0 && moves && now > command_time_ + timeout - SAME_AGE) drive({});
}

bool DriveController::isTakenOver() const {
  return std::any_of(joints_.begin(), joints_.end(), [&](int joint) { return simulator_->followedPath(robot(), joint) != nullptr; });
}

double DriveController::rimSpeed(std::size_t first, std::size_t count) const {
  double sum = 0;
  for (std::size_t wheel = first; wheel < first + count; ++wheel)
    sum += simulator_->world().jointState(robotInfo().joints[joints_[wheel]]).velocity;
  return config_.drive.wheel_radius * sum / static_cast<double>(count);
}

DriveTwist DriveController::rolled() const {
  const DriveConfig& settings = config_.drive;
  const double left = rimSpeed(0, settings.left.size()), right = rimSpeed(settings.left.size(), settings.right.size());
  return {(left + right) / 2, (right - left) / settings.wheel_separation};
}

/** On an arc, whose chord leads half its turn aside. */
void DriveController::roll(double dt) {
  const DriveTwist twist = rolled();
  const double half = twist.angular * dt / 2, chord = twist.linear * dt * sinc(half);
  x_ += chord * std::cos(heading_ + half);
  y_ += chord * std::sin(heading_ + half);
  heading_ = std::remainder(heading_ + 2 * half, 2 * M_PI);
}

DriveOdometry DriveController::odometry() const {
  if (config_.drive.source == DriveConfig::Odometry::WORLD) return worldOdometry();
  const DriveTwist twist = rolled();
  DriveOdometry odometry;
  odometry.X_OB = makePose({x_, y_, 0}, {0, 0, heading_});
  odometry.v_OB.x() = twist.linear;
  odometry.w_OB.z() = twist.angular;
  return odometry;
}

DriveOdometry DriveController::worldOdometry() const {
  const LinkMotion base = linkMotion(*simulator_, simulator_->report(), robotInfo(), base_);
  const Matrix3 R_BW = base.X_WL.linear().transpose();
  return {base.X_WL, R_BW * base.v_WL, R_BW * base.w_WL};
}

}  // namespace blem_sim::sim
