#include "commands/joint_motor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace blem_sim::sim {
namespace {

// The implicit law's effort is bounded in the solve; beyond this much of the limit, relative, it asked for more.
constexpr double SATURATION_TOLERANCE = 1e-6;
constexpr double AT_VELOCITY = 1e-3;     // of the limit, relative: the joint moves as fast as the motor may drive it
constexpr double TIME_TOLERANCE = 1e-9;  // [s] rounding of times that are sums of steps
// Joints that a given effort could bring to their velocity limit in this many steps, alone against the least inertia, get a row that ends
// it there; a row costs little, so the number is large against what other joints' inertia may add.
constexpr double STEPS_TO_LIMIT = 100;
constexpr double RIGID = 1e6;  // gain of that row over the inertia: what it gives misses the limit by a millionth of the step's change

double clamped(double x, double bound) { return std::max(-bound, std::min(bound, x)); }

}  // namespace

JointMotor::JointMotor(const MotorSettings& settings, double initial_position) : settings_(settings), initial_position_(initial_position) {
  reset();
}

void JointMotor::reset() {
  hold(initial_position_);
  added_effort_ = integral_ = 0;
  free_way_.reset();
}

/** A mode's targets end with it. */
void JointMotor::enter(Mode mode) {
  if (mode_ == Mode::EFFORT) added_effort_ = 0;
  mode_ = mode;
  velocity_target_ = 0;
}

void JointMotor::follow(double now, double start, std::vector<JointSpline::Knot> knots, double position) {
  if (mode_ != Mode::POSITION) spline_ = JointSpline(position);
  enter(Mode::POSITION);
  spline_.splice(now, start, std::move(knots), settings_.continuous);
}

void JointMotor::hold(double position, double velocity) {
  spline_ = JointSpline(position);
  enter(Mode::POSITION);
  velocity_target_ = velocity;
}

void JointMotor::keepVelocity(double velocity, double now) {
  enter(Mode::VELOCITY);
  velocity_target_ = velocity;
  command_time_ = now;
  integral_ = 0;
}

void JointMotor::keepEffort(double effort, double now) {
  enter(Mode::EFFORT);
  added_effort_ = effort;
  command_time_ = now;
  integral_ = 0;
}

void JointMotor::driveVelocity(const VelocityDrive& target, double now) {
  const double present = mode_ == Mode::POSITION ? 0 : velocityTarget(now);
  enter(Mode::DRIVE);
  velocity_target_ = target.velocity;
  ramp_ = target;
  ramp_.velocity = present;
  command_time_ = now;
  integral_ = added_effort_ = 0;
}

double JointMotor::velocityTarget(double time) const {
  if (mode_ != Mode::DRIVE || ramp_.acceleration == 0) return velocity_target_;
  return ramp_.velocity + clamped(velocity_target_ - ramp_.velocity, ramp_.acceleration * std::max(time - command_time_, 0.0));
}

JointSample JointMotor::desired(double time) const {
  JointSample sample = spline_.sample(time);
  if (mode_ != Mode::POSITION) sample.velocity = sample.effort = 0;
  sample.velocity += velocityTarget(time);
  sample.effort += added_effort_;
  return sample;
}

void JointMotor::sample(double time, double dt) {
  now_ = time;
  dt_ = dt;
  sample_ = desired(settings_.law == MotorLaw::PID && mode_ != Mode::DRIVE ? time : time + dt);
}

bool JointMotor::isOverdue() const {
  return mode_ != Mode::POSITION && settings_.command_timeout > 0 && now_ > command_time_ + settings_.command_timeout - TIME_TOLERANCE;
}

double JointMotor::damping() const {
  if (mode_ == Mode::EFFORT) return 0;
  return mode_ == Mode::VELOCITY ? settings_.velocity_gain.value_or(settings_.gains.d) : settings_.gains.d;
}

void JointMotor::setVelocities(double position, dynamics::JointDrive* drive) {
  const double limit = settings_.velocity_limit;
  max_velocity_ = limit;
  min_velocity_ = -limit;
  const model::SafetyController safety = settings_.safety.value_or(model::SafetyController());
  if (safety.k_position > 0 && safety.lower < safety.upper) {
    max_velocity_ = clamped(safety.k_position * (safety.upper - position), limit);
    min_velocity_ = clamped(safety.k_position * (safety.lower - position), limit);
  }
  if (safety.k_velocity > 0) drive->velocity_gain = safety.k_velocity;
  drive->max_velocity = max_velocity_;
  drive->min_velocity = min_velocity_;
}

dynamics::JointDrive JointMotor::drive(const dynamics::JointState& state) {
  dynamics::JointDrive drive;
  drive.dry_friction = settings_.friction.dry;
  drive.viscous_friction = settings_.friction.viscous;
  capped_ = false;
  error_ = 0;
  given_effort_.reset();
  if (!settings_.commanded) return drive;
  if (isOverdue()) {
    hold(state.position);
    sample(now_, dt_);
  }
  setVelocities(state.position, &drive);
  if (mode_ == Mode::DRIVE) {
    driveExactly(&drive);
    return drive;
  }
  const double stiffness = mode_ == Mode::POSITION ? settings_.gains.p : 0;
  error_ = mode_ == Mode::POSITION ? sample_.position - state.position : 0;
  const double feed_forward = integral_ + sample_.effort;
  if (settings_.law == MotorLaw::IMPLICIT_PD && stiffness + damping() > 0) {
    // The feed-forward goes into the target, so that one bound holds for the sum.
    drive.stiffness = stiffness;
    drive.damping = damping();
    drive.max_effort = settings_.effort_limit;
    drive.target_position = sample_.position + (stiffness > 0 ? feed_forward / stiffness : 0);
    drive.target_velocity = sample_.velocity + (stiffness > 0 ? 0 : feed_forward / damping());
    return drive;
  }
  giveEffort(stiffness * error_ + damping() * (sample_.velocity - wayVelocity(state)) + feed_forward, state.velocity, &drive);
  return drive;
}

// A joint that rests on a robot that whirls round ends each step with half a step of its free acceleration: its way is none.
double JointMotor::wayVelocity(const dynamics::JointState& state) const {
  const bool is_its_end = free_way_ && free_way_->position == state.position && free_way_->velocity == state.velocity;
  return is_its_end ? state.velocity - free_way_->speed : state.velocity;
}

void JointMotor::driveExactly(dynamics::JointDrive* drive) const {
  drive->damping = RIGID * (settings_.inertia > 0 ? settings_.inertia : 1) / dt_;
  drive->target_velocity = sample_.velocity;
  drive->max_effort = ramp_.max_effort > 0 ? std::min(ramp_.max_effort, settings_.effort_limit) : settings_.effort_limit;
}

void JointMotor::giveEffort(double effort, double velocity, dynamics::JointDrive* drive) {
  given_effort_ = clamped(effort, settings_.effort_limit);
  capped_ = *given_effort_ != effort;
  const double limit = std::exchange(drive->max_velocity, INFINITY), lower = std::exchange(drive->min_velocity, -INFINITY);
  const double room = *given_effort_ > 0 ? limit - velocity : velocity - lower;
  if (!(settings_.inertia > 0) || STEPS_TO_LIMIT * dt_ * std::abs(*given_effort_) < settings_.inertia * room) {
    drive->effort = *given_effort_;
    return;
  }
  drive->damping = std::min(RIGID * settings_.inertia / dt_, drive->velocity_gain);
  drive->target_velocity = *given_effort_ > 0 ? limit : lower;
  drive->max_effort = std::abs(*given_effort_);
}

bool JointMotor::atVelocityLimit(double effort, double velocity) const {
  const double limit = effort > 0 ? max_velocity_ : -min_velocity_, along = effort > 0 ? velocity : -velocity;
  return along >= limit - AT_VELOCITY * std::abs(limit);
}

bool JointMotor::accept(const dynamics::JointDrive& drive, const dynamics::JointState& after, double dt) {
  if (!settings_.commanded) return false;
  const double asked =
      given_effort_ ? *given_effort_
                    : drive.stiffness * (drive.target_position - after.position) + drive.damping * (drive.target_velocity - after.velocity);
  const bool held_back = atVelocityLimit(asked, after.velocity);
  const bool saturated = capped_ || (!held_back && std::abs(asked) > drive.max_effort * (1 + SATURATION_TOLERANCE));
  // Effort beyond a limit is not asked for later either: the integral does not wind up.
  const bool winds_up = (saturated || held_back) && asked * error_ > 0;
  if (!winds_up) integrate(dt);
  return saturated;
}

void JointMotor::noteFreeWay(const dynamics::JointState& after, double speed) {
  free_way_.reset();
  if (speed != 0 && settings_.law == MotorLaw::PID) free_way_ = {after.position, after.velocity, speed};
}

/** An error from a target at rest that dry friction holds against p alone is not integrated: the joint would stick and slip about its
 * target for ever. */
void JointMotor::integrate(double dt) {
  const JointGains& gains = settings_.gains;
  if (gains.i > 0 && sample_.velocity == 0 && gains.p * std::abs(error_) < settings_.friction.dry) return;
  integral_ = clamped(integral_ + gains.i * error_ * dt, gains.i_clamp);
}

void JointMotor::save(geometry::StateWriter* writer) const {
  const double known = free_way_ ? static_cast<double>(Mode::COUNT) : 0;  // most joints have nothing to tell
  writer->numbers({static_cast<double>(mode_) + known, velocity_target_, added_effort_, integral_});
  if (mode_ != Mode::POSITION) writer->number(command_time_);
  if (mode_ == Mode::DRIVE) writer->numbers({ramp_.velocity, ramp_.acceleration, ramp_.max_effort});
  if (free_way_) writer->numbers({free_way_->position, free_way_->velocity, free_way_->speed});
  spline_.save(writer);
}

void JointMotor::restoreRamp(geometry::StateReader* reader) {
  for (double* number : {&ramp_.velocity, &ramp_.acceleration, &ramp_.max_effort}) *number = reader->number();
  if (ramp_.acceleration < 0 || ramp_.max_effort < 0) reader->refuseContent("a motor's acceleration or effort is below 0");
}

void JointMotor::restore(geometry::StateReader* reader) {
  constexpr int MODES = static_cast<int>(Mode::COUNT);
  const int mode = reader->choice(2 * MODES);
  mode_ = static_cast<Mode>(mode % MODES);
  velocity_target_ = reader->number();
  added_effort_ = reader->number();
  integral_ = reader->number();
  command_time_ = mode_ == Mode::POSITION ? 0 : reader->number();
  ramp_ = VelocityDrive();
  if (mode_ == Mode::DRIVE) restoreRamp(reader);
  free_way_.reset();
  if (mode >= MODES) {
    FreeWay way;
    for (double* number : {&way.position, &way.velocity, &way.speed}) *number = reader->number();
    free_way_ = way;
  }
  spline_.restore(reader);
}

}  // namespace blem_sim::sim
