#include "commands/joint_motor.h"

#include <algorithm>
#include <cmath>

#include "numbers/number_reader.h"

namespace blem_sim {
namespace {

// The implicit law's effort is bounded in the solve; beyond this much of the limit, relative, it asked for more.
constexpr double SATURATION_TOLERANCE = 1e-6;

double clamped(double x, double bound) { return std::max(-bound, std::min(bound, x)); }

}  // namespace

JointMotor::JointMotor(const MotorSettings& settings, double initial_position) : settings_(settings), initial_position_(initial_position) {
  reset();
}

void JointMotor::reset() {
  hold(initial_position_);
  added_effort_ = integral_ = 0;
}

void JointMotor::follow(double now, double start, std::vector<JointSpline::Knot> knots, double position) {
  if (velocity_only_) spline_ = JointSpline(position);
  velocity_only_ = false;
  velocity_target_ = 0;
  spline_.splice(now, start, std::move(knots), settings_.continuous);
}

void JointMotor::hold(double position, double velocity) {
  spline_ = JointSpline(position);
  velocity_only_ = false;
  velocity_target_ = velocity;
}

void JointMotor::keepVelocity(double velocity) {
  velocity_only_ = true;
  velocity_target_ = velocity;
  integral_ = 0;
}

JointSample JointMotor::desired(double time) const {
  JointSample sample = spline_.sample(time);
  if (velocity_only_) sample.velocity = sample.effort = 0;
  sample.velocity += velocity_target_;
  sample.effort += added_effort_;
  return sample;
}

void JointMotor::sample(double time, double dt) { sample_ = desired(settings_.law == MotorLaw::PID ? time : time + dt); }

JointDrive JointMotor::drive(const JointState& state) {
  JointDrive drive;
  drive.dry_friction = settings_.friction.dry;
  drive.viscous_friction = settings_.friction.viscous;
  capped_ = false;
  if (!settings_.commanded) return drive;
  const JointGains& gains = settings_.gains;
  const double stiffness = velocity_only_ ? 0 : gains.p;
  error_ = velocity_only_ ? 0 : sample_.position - state.position;
  const double feed_forward = integral_ + sample_.effort;
  if (settings_.law == MotorLaw::IMPLICIT_PD && stiffness + gains.d > 0) {
    // The feed-forward goes into the target, so that one bound holds for the sum.
    drive.stiffness = stiffness;
    drive.damping = gains.d;
    drive.max_effort = settings_.effort_limit;
    drive.target_position = sample_.position + (stiffness > 0 ? feed_forward / stiffness : 0);
    drive.target_velocity = sample_.velocity + (stiffness > 0 ? 0 : feed_forward / gains.d);
    return drive;
  }
  const double effort = stiffness * error_ + gains.d * (sample_.velocity - state.velocity) + feed_forward;
  drive.effort = clamped(effort, settings_.effort_limit);
  capped_ = drive.effort != effort;
  return drive;
}

bool JointMotor::accept(const JointDrive& drive, const JointState& after, double dt) {
  if (!settings_.commanded) return false;
  const double asked =
      drive.stiffness * (drive.target_position - after.position) + drive.damping * (drive.target_velocity - after.velocity);
  const bool saturated = capped_ || std::abs(asked) > drive.max_effort * (1 + SATURATION_TOLERANCE);
  // Effort beyond the limit is not asked for later either: the integral does not wind up.
  const bool winds_up = saturated && (capped_ ? drive.effort : asked) * error_ > 0;
  if (!winds_up) integral_ = clamped(integral_ + settings_.gains.i * error_ * dt, settings_.gains.i_clamp);
  return saturated;
}

void JointMotor::append(std::vector<double>* numbers) const {
  numbers->insert(numbers->end(), {velocity_only_ ? 1.0 : 0.0, velocity_target_, added_effort_, integral_});
  spline_.append(numbers);
}

void JointMotor::read(NumberReader* reader) {
  velocity_only_ = reader->flag();
  velocity_target_ = reader->number();
  added_effort_ = reader->number();
  integral_ = reader->number();
  spline_.read(reader);
}

}  // namespace blem_sim
