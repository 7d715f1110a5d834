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
#include "wheels/undercarriage.h"
#include "wheels/wheel_measures.h"

namespace blem_sim::sim {
namespace {

constexpr double SAME_AGE = 1e-9;     // [s] rounding of times that are sums of steps
constexpr double ANY_RAMP = 1e6;      // [s] after which every ramp has ended
constexpr double SMALL_ANGLE = 1e-4;  // [rad] up to which two terms of the sine's series are exact

/** sin(x) / x */
double sinc(double x) { return std::abs(x) < SMALL_ANGLE ? 1 - x * x / 6 : std::sin(x) / x; }

/** @throws InputError: a joint that is there twice, or cannot be driven */
std::vector<int> jointsOf(const RobotInfo& robot, const ControllerConfig& config) {
  if (config.kind == ControllerKind::PLANAR_DRIVE) return {};
  for (const std::string& joint : config.joints)
    if (std::count(config.joints.begin(), config.joints.end(), joint) > 1)
      throw InputError(fmt::format("controller '{}': joint '{}' is there twice; name it once", config.name, joint));
  return controlledJoints(robot, config);
}

constexpr std::size_t MEMORY_SIZE = 16;

}  // namespace

/** Numbers that the simulator keeps for the drive from step to step. */
struct DriveController::Memory {
  double steps = 0;         ///< when update was called last
  double command_time = 0;  ///< [s]
  double moves = 0;         ///< 1: the command is to move
  double x = 0, y = 0, heading = 0;
  DriveTwist wanted;
  LimitedSpeed linear, angular;  ///< of the step before
  double steering = 0;           ///< [rad] of the step before
  LimitedSpeed lateral;          ///< of the step before

  static Memory from(const std::array<double, MEMORY_SIZE>& n) {
    return {n[0], n[1], n[2], n[3], n[4], n[5], {n[6], n[7], n[13]}, {n[8], n[9]}, {n[10], n[11]}, n[12], {n[14], n[15]}};
  }
  std::array<double, MEMORY_SIZE> numbers() const {
    return {steps,
            command_time,
            moves,
            x,
            y,
            heading,
            wanted.linear,
            wanted.angular,
            linear.speed,
            linear.acceleration,
            angular.speed,
            angular.acceleration,
            steering,
            wanted.lateral,
            lateral.speed,
            lateral.acceleration};
  }
};

DriveController::DriveController(Simulator* simulator, int robot, ControllerConfig config)
    : simulator_(simulator),
      robot_(simulator->robots().at(robot).name),
      config_(std::move(config)),
      joints_(jointsOf(simulator->robots().at(robot), config_)) {
  if (isPlanar()) simulator->checkBase(robot);
  const model::RobotModel& model = *simulator->robots()[robot].description;
  config_.drive = measured(config_, model);
  undercarriage_ = undercarriageOf(config_, model);
  for (const std::string& wheel : undercarriage_->wheels())
    wheels_.push_back(joints_[std::find(config_.joints.begin(), config_.joints.end(), wheel) - config_.joints.begin()]);
  const int link = model.linkIndex(config_.drive.base_frame);
  base_ = link < 0 ? model.root : link;
}

int DriveController::robot() const { return controlledRobot(*simulator_, config_, robot_); }

std::vector<std::string> DriveController::claims() const {
  return isPlanar() ? std::vector<std::string>{robotInfo().root_link} : config_.joints;
}

void DriveController::start() {
  running_ = true;
  restart();
}

void DriveController::stop() {
  if (running_ && isPlanar())
    simulator_->releaseBase(robot());
  else if (running_)
    drive(std::vector<double>(wheels_.size()));
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
  memory.steering = undercarriage_->angleOf(jointStates());
  if (config_.drive.steering.takes_angles) memory.wanted.angular = memory.angular.speed = memory.steering;
  return memory;
}

void DriveController::restart() {
  Memory memory = atRest();
  want({}, &memory);
  keep(memory);
}

void DriveController::command(const DriveTwist& twist) {
  if (!running_) throw InputError(fmt::format("controller '{}' is stopped; start it by switch_controller", config_.name));
  for (const auto& [field, number] : {std::make_pair("linear.x", twist.linear), std::make_pair("linear.y", isPlanar() ? twist.lateral : 0),
                                      std::make_pair("angular.z", twist.angular)})
    if (!isCommand(number))
      throw InputError(fmt::format("twist: {}: is {}; give a finite number within {:g}", field, number, LARGEST_COMMAND));
  Memory memory = recall();
  requireCommandable(twist, memory);
  want(twist, &memory);
  memory.command_time = simulator_->time();
  memory.moves = twist.linear != 0 || twist.angular != 0 || (isPlanar() && twist.lateral != 0);
  keep(memory);
}

DriveTwist DriveController::allowed(const DriveTwist& twist) const {
  const DriveConfig& limits = config_.drive;
  return {allowedSpeed(twist.linear, limits.linear), allowedSpeed(twist.angular, limits.angular),
          isPlanar() ? allowedSpeed(twist.lateral, limits.lateral) : 0};
}

void DriveController::requireCommandable(const DriveTwist& twist, Memory memory) const {
  memory.wanted = allowed(twist);
  memory.linear.speed = memory.wanted.linear;
  memory.angular.speed = memory.wanted.angular;
  memory.steering = wantedAngle(memory);
  const std::vector<double> turns = velocities(memory);
  for (std::size_t wheel = 0; wheel < turns.size(); ++wheel)
    if (!isCommand(turns[wheel]))
      throw InputError(fmt::format("twist: wheel '{}' would get a velocity of {:g} rad/s; give a twist that keeps it within {:g}",
                                   undercarriage_->wheels()[wheel], turns[wheel], LARGEST_COMMAND));
}

void DriveController::want(const DriveTwist& twist, Memory* memory) {
  memory->wanted = allowed(twist);
  Memory next = *memory;
  changeSpeeds(&next);
  if (isPlanar()) return push(next);
  drive(velocities(next));
  steer(next.steering);
}

double DriveController::wantedAngle(const Memory& memory) const {
  DriveTwist wanted = memory.wanted;
  const bool ends = wanted.linear == 0 && wanted.angular == 0;
  // A turn that fades within its limits, at the end of a twist, is none in place.
  if (!ends || config_.drive.steering.takes_angles) wanted.angular = memory.angular.speed;
  return undercarriage_->angleFor(wanted, memory.steering);
}

void DriveController::changeSpeeds(Memory* memory) const {
  const double dt = simulator_->config().time_step;
  memory->linear = speedAfterStep(memory->linear, memory->wanted.linear, config_.drive.linear, dt);
  memory->angular = speedAfterStep(memory->angular, memory->wanted.angular, config_.drive.angular, dt);
  memory->lateral = speedAfterStep(memory->lateral, memory->wanted.lateral, config_.drive.lateral, dt);
  const double angle = wantedAngle(*memory), most = config_.drive.steering.speed * dt;
  memory->steering = most > 0 ? std::clamp(angle, memory->steering - most, memory->steering + most) : angle;
}

bool DriveController::isUnderWay(const Memory& memory) const {
  return memory.linear.speed != memory.wanted.linear || memory.angular.speed != memory.wanted.angular ||
         memory.lateral.speed != memory.wanted.lateral || memory.steering != wantedAngle(memory);
}

std::vector<double> DriveController::velocities(const Memory& memory) const {
  return undercarriage_->velocities({memory.linear.speed, memory.angular.speed}, {wantedAngle(memory), memory.steering});
}

void DriveController::drive(const std::vector<double>& velocities) {
  const DriveConfig& settings = config_.drive;
  JointVelocityCommand command;
  command.joints = undercarriage_->wheels();
  // While steering is under way, wheels may be to turn faster than at its end.
  for (const double velocity : velocities) command.velocities.push_back(std::clamp(velocity, -LARGEST_COMMAND, LARGEST_COMMAND));
  command.acceleration = settings.wheel_acceleration / settings.wheel_radius;
  command.max_effort = settings.wheel_torque;
  simulator_->driveJoints(robot(), command);
}

void DriveController::push(const Memory& memory) {
  const DriveConfig& settings = config_.drive;
  simulator_->driveBase(robot(), base_,
                        {memory.linear.speed, memory.lateral.speed, memory.angular.speed, settings.max_force, settings.max_torque});
}

void DriveController::steer(double angle) {
  if (undercarriage_->steering().empty()) return;
  simulator_->commandJoints(robot(), {undercarriage_->steering(), undercarriage_->positions(angle), {}, {}});
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
  if (ends)
    want({}, &memory);
  else if (isUnderWay(memory))
    want(memory.wanted, &memory);
  keep(memory);
}

bool DriveController::isCommanded() const {
  const BaseVelocityCommand* const base = simulator_->baseCommand(robot());
  if (isPlanar()) return base && (base->x != 0 || base->y != 0 || base->turn != 0);
  const double then = simulator_->time() + ANY_RAMP;
  return std::any_of(wheels_.begin(), wheels_.end(),
                     [&](int joint) { return simulator_->desiredState(robot(), joint, then).velocity != 0; });
}

bool DriveController::isTakenOver() const {
  if (isPlanar()) return !simulator_->baseCommand(robot());
  return std::any_of(wheels_.begin(), wheels_.end(), [&](int joint) { return simulator_->followedPath(robot(), joint) != nullptr; });
}

std::vector<dynamics::JointState> DriveController::jointStates() const {
  std::vector<dynamics::JointState> states;
  for (const int joint : joints_) states.push_back(simulator_->world().jointState(robotInfo().joints[joint]));
  return states;
}

DriveTwist DriveController::rolled() const { return undercarriage_->rolled(jointStates()); }

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
  const Vector3 middle(undercarriage_->middle().x(), undercarriage_->middle().y(), 0);
  const Pose X_SM = makePose({memory.x, memory.y, 0}, {0, 0, memory.heading});  // the middle, from where it started
  odometry.X_OB = makePose(middle) * X_SM * makePose(-middle);
  odometry.v_OB = {twist.linear + twist.angular * middle.y(), -twist.angular * middle.x(), 0};
  odometry.w_OB.z() = twist.angular;
  return odometry;
}

DriveOdometry DriveController::worldOdometry() const {
  const LinkMotion base = linkMotion(*simulator_, simulator_->report(), robotInfo(), base_);
  const Matrix3 R_BW = base.X_WL.linear().transpose();
  return {base.X_WL, R_BW * base.v_WL, R_BW * base.w_WL};
}

}  // namespace blem_sim::sim
