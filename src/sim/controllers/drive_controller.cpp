#include "blem_sim/sim/drive_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/link_motion.h"
#include "controllers/controlled_joints.h"
#include "controllers/limited_speed.h"
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

constexpr std::size_t MEMORY_SIZE = 12;

}  // namespace

/** Numbers that the simulator keeps for the drive from step to step. */
struct DriveController::Memory {
  double steps = 0;         ///< when update was called last
  double command_time = 0;  ///< [s]
  double moves = 0;         ///< 1: the command is to move
  double x = 0, y = 0, heading = 0;
  DriveTwist wanted;
  LimitedSpeed linear, angular;  ///< of the step before

  static Memory from(const std::array<double, MEMORY_SIZE>& n) {
    return {n[0], n[1], n[2], n[3], n[4], n[5], {n[6], n[7]}, {n[8], n[9]}, {n[10], n[11]}};
  }
  std::array<double, MEMORY_SIZE> numbers() const {
    return {steps,         command_time,        moves, x, y, heading, wanted.linear, wanted.angular, linear.speed, linear.acceleration,
            angular.speed, angular.acceleration};
  }
};

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
  const std::vector<double> kept = simulator_->memory(robot_, config_.name);
  std::array<double, MEMORY_SIZE> numbers{};
  if (kept.size() == numbers.size() && std::all_of(kept.begin(), kept.end(), [](double number) { return std::isfinite(number); })) {
    std::copy(kept.begin(), kept.end(), numbers.begin());
    return Memory::from(numbers);
  }
  Memory memory = atRest();
  memory.moves = isCommanded() ? 1 : 0;
  return memory;
}

void DriveController::keep(const Memory& memory) {
  const auto numbers = memory.numbers();
  simulator_->remember(robot_, config_.name, {numbers.begin(), numbers.end()});
}

DriveController::Memory DriveController::atRest() const {
  Memory memory;
  memory.steps = static_cast<double>(simulator_->steps());
  memory.command_time = simulator_->time();
  return memory;
}

void DriveController::restart() {
  keep(atRest());
  drive({});
}

void DriveController::command(const DriveTwist& twist) {
  if (!running_) throw InputError(fmt::format("controller '{}' is stopped; start it by switch_controller", config_.name));
  for (const auto& [field, number] : {std::make_pair("linear.x", twist.linear), std::make_pair("angular.z", twist.angular)})
    if (!isCommand(number))
      throw InputError(fmt::format("twist: {}: is {}; give a finite number within {:g}", field, number, LARGEST_COMMAND));
  Memory memory = recall();
  want(twist, &memory);
  memory.command_time = simulator_->time();
  memory.moves = twist.linear != 0 || twist.angular != 0;
  keep(memory);
}

void DriveController::want(const DriveTwist& twist, Memory* memory) {
  memory->wanted = {allowedSpeed(twist.linear, config_.drive.linear), allowedSpeed(twist.angular, config_.drive.angular)};
  Memory next = *memory;
  changeSpeeds(&next);
  drive({next.linear.speed, next.angular.speed});
}

void DriveController::changeSpeeds(Memory* memory) const {
  const double dt = simulator_->config().time_step;
  memory->linear = speedAfterStep(memory->linear, memory->wanted.linear, config_.drive.linear, dt);
  memory->angular = speedAfterStep(memory->angular, memory->wanted.angular, config_.drive.angular, dt);
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
  if (static_cast<double>(simulator_->steps()) == memory.steps + 1) {
    roll(&memory);
    changeSpeeds(&memory);
  }
  memory.steps = static_cast<double>(simulator_->steps());
  const double timeout = config_.drive.cmd_vel_timeout;
  const bool ends = timeout > 0 && memory.moves != 0 && simulator_->time() > memory.command_time + timeout - SAME_AGE;
  if (ends) memory.moves = 0;
  const DriveTwist wanted = ends ? DriveTwist{} : memory.wanted;
  if (ends || memory.linear.speed != wanted.linear || memory.angular.speed != wanted.angular) want(wanted, &memory);
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
