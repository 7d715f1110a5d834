#include "blem_sim/sim/drive_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/link_motion.h"
#include "controllers/controlled_joints.h"
#include "controllers/wheel_measures.h"

namespace blem_sim::sim {
namespace {

constexpr double SAME_AGE = 1e-9;     // [s] rounding of times that are sums of steps
constexpr double ANY_RAMP = 1e6;      // [s] after which every ramp has ended
constexpr double SMALL_ANGLE = 1e-4;  // [rad] up to which two terms of the sine's series are exact

/** sin(x) / x */
double sinc(double x) { return std::abs(x) < SMALL_ANGLE ? 1 - x * x / 6 : std::sin(x) / x; }

std::vector<int> wheelsOf(const RobotInfo& robot, const ControllerConfig& config) {
  const DriveConfig& drive = config.drive;
  if (drive.left.empty() || drive.right.empty())
    throw InputError(fmt::format("controller '{}': needs left_wheel and right_wheel", config.name));
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
  config_.drive = measured(config_, model);
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
  simulator_->remember(robot_, config_.name, {});
}

DriveController::Memory DriveController::recall() const {
  const std::vector<double> n = simulator_->memory(robot_, config_.name);
  const bool sound = n.size() == 6 && std::all_of(n.begin(), n.end(), [](double number) { return std::isfinite(number); });
  if (sound) return {n[0], n[1], n[2], n[3], n[4], n[5]};
  return {static_cast<double>(simulator_->steps()), simulator_->time(), isCommanded() ? 1.0 : 0.0, 0, 0, 0};
}

void DriveController::keep(const Memory& memory) {
  simulator_->remember(robot_, config_.name, {memory.steps, memory.command_time, memory.moves, memory.x, memory.y, memory.heading});
}

void DriveController::restart() {
  keep({static_cast<double>(simulator_->steps()), simulator_->time(), 0, 0, 0, 0});
  drive({});
}

void DriveController::command(const DriveTwist& twist) {
  if (!running_) throw InputError(fmt::format("controller '{}' is stopped; start it by switch_controller", config_.name));
  for (const auto& [field, number] : {std::make_pair("linear.x", twist.linear), std::make_pair("angular.z", twist.angular)})
    if (!isCommand(number))
      throw InputError(fmt::format("twist: {}: is {}; give a finite number within {:g}", field, number, LARGEST_COMMAND));
  drive(twist);
  Memory memory = recall();
  memory.command_time = simulator_->time();
  memory.moves = twist.linear != 0 || twist.angular != 0;
  keep(memory);
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
}

void DriveController::update() {
  if (!running_) return;
  if (isTakenOver()) return restart();
  Memory memory = recall();
  // A state that is restored has the memory of its own step: its wheels have not rolled to where they are.
  if (static_cast<double>(simulator_->steps()) == memory.steps + 1) roll(&memory);
  memory.steps = static_cast<double>(simulator_->steps());
  const double timeout = config_.drive.cmd_vel_timeout;
  if (timeout > 0 && memory.moves != 0 && simulator_->time() > memory.command_time + timeout - SAME_AGE) {
    memory.moves = 0;
    drive({});
  }
  keep(memory);
}

bool DriveController::isCommanded() const {
  const double then = simulator_->time() + ANY_RAMP;
  return std::any_of(joints_.begin(), joints_.end(),
                     [&](int joint) { return simulator_->desiredState(robot(), joint, then).velocity != 0; });
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
void DriveController::roll(Memory* memory) const {
  const DriveTwist twist = rolled();
  const double dt = simulator_->config().time_step;
  const double half = twist.angular * dt / 2, chord = twist.linear * dt * sinc(half);
  memory->x += chord * std::cos(memory->heading + half);
  memory->y += chord * std::sin(memory->heading + half);
  memory->heading = std::remainder(memory->heading + 2 * half, 2 * M_PI);
}

DriveOdometry DriveController::odometry() const {
  if (config_.drive.source == DriveConfig::Odometry::WORLD) return worldOdometry();
  const DriveTwist twist = rolled();
  const Memory memory = recall();
  DriveOdometry odometry;
  odometry.X_OB = makePose({memory.x, memory.y, 0}, {0, 0, memory.heading});
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
