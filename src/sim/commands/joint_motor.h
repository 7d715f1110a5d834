// One joint's motor: its commands, and the effort that follows from them.
#pragma once

#include <optional>
#include <vector>

#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"
#include "blem_sim/sim/trajectory.h"

namespace blem_sim::sim {

struct MotorSettings {
  JointGains gains;
  std::optional<double> velocity_gain;  ///< [N m s/rad or N s/m] instead of gains.d while a velocity is commanded
  MotorLaw law = MotorLaw::PID;
  JointFriction friction;
  double effort_limit = std::numeric_limits<double>::infinity();    ///< [N m or N]
  double velocity_limit = std::numeric_limits<double>::infinity();  ///< [rad/s or m/s] beyond which the motor does not drive
  std::optional<model::SafetyController> safety;
  double inertia = 0;          ///< [kg m^2 or kg] that its effort meets at least; 0: not known, and Eq. 7 knows no velocity limit
  double command_timeout = 0;  ///< [s] after which a velocity or an effort that was commanded ends; 0: never
  bool continuous = false;     ///< positions are meant to the nearest turn
  bool commanded = false;      ///< false: no motor of its own (a fixed joint, a mimic joint); friction stays
};

/** A velocity [rad/s or m/s] that a motor is to come to. */
struct VelocityDrive {
  double velocity = 0;
  double acceleration = 0;  ///< [rad/s^2 or m/s^2] on the way, from the velocity commanded before; 0: at once
  double max_effort = 0;    ///< [N m or N] beside the motor's limit; 0: that alone
};

/** Follows a trajectory, holds a target, keeps a velocity (an effort adds to each), or gives an effort. State: all of these, integral term.
 */
class JointMotor {
 public:
  JointMotor() = default;
  JointMotor(const MotorSettings& settings, double initial_position);

  /** Makes the motor hold the initial position again, integral 0. */
  void reset();
  /** Takes over a trajectory's knots. @param position [rad or m] of the joint now, from which a velocity or an effort is left */
  void follow(double now, double start, std::vector<JointSpline::Knot> knots, double position);
  void hold(double position, double velocity = 0);
  /** Velocity alone: damping against the velocity error, no stiffness; the integral and a trajectory's effort end. */
  void keepVelocity(double velocity, double now);
  /** Effort alone: no stiffness, no damping; integral and trajectory end. */
  void keepEffort(double effort, double now);
  /** Velocity alone, kept as exactly as the effort allows whatever the gains are, with a ramp towards it. */
  void driveVelocity(const VelocityDrive& target, double now);
  void addEffort(double effort) { added_effort_ = effort; }

  JointSample desired(double time) const;

  /** Latches the desired state for the coming (sub)step: Eq. 7 takes that at its start, the implicit law that at its end. */
  void sample(double time, double dt);
  /** Drive of the joint in the coming (sub)step, within effort and velocity limits [Hauser 2013, Eq. 7 and 4.1]. */
  dynamics::JointDrive drive(const dynamics::JointState& state);
  /** Call after an accepted (sub)step: integrates, and notes whether the effort limit was met. @return true if it was */
  bool accept(const dynamics::JointDrive& drive, const dynamics::JointState& after, double dt);
  /** Call then. Eq. 7 answers to the velocity of the way, not to that at its end. @param speed SolveResult::free_speeds of the joint */
  void noteFreeWay(const dynamics::JointState& after, double speed);

  /** Path that is followed; null while a velocity or an effort is kept. */
  const JointSpline* path() const { return mode_ == Mode::POSITION ? &spline_ : nullptr; }

  const MotorSettings& settings() const { return settings_; }
  /** The gain for velocities becomes that of the others, too. */
  void setGains(const JointGains& gains) {
    settings_.gains = gains;
    settings_.velocity_gain.reset();
  }
  void setViscousFriction(double friction) { settings_.friction.viscous = friction; }
  void setInertia(double inertia) { settings_.inertia = inertia; }
  void save(geometry::StateWriter* writer) const;
  void restore(geometry::StateReader* reader);

 private:
  enum class Mode { POSITION, VELOCITY, EFFORT, DRIVE, COUNT };

  /** State [rad or m, rad/s or m/s] at the end of a free way, and by how much its velocity is above that of the way. */
  struct FreeWay {
    double position = 0, velocity = 0, speed = 0;
  };

  void enter(Mode mode);
  bool isOverdue() const;
  double damping() const;
  /** That adds to the spline's. */
  double velocityTarget(double time) const;
  void driveExactly(dynamics::JointDrive* drive) const;
  /** Velocities between which the motor drives in the coming (sub)step. */
  void setVelocities(double position, dynamics::JointDrive* drive);
  /** An effort given in advance, ended by the step's solution where it could drive the joint beyond its velocities. */
  void giveEffort(double effort, double velocity, dynamics::JointDrive* drive);
  bool atVelocityLimit(double effort, double velocity) const;
  void integrate(double dt);
  /** [rad/s or m/s] Velocity of the way that led to a state, as an encoder tells it. */
  double wayVelocity(const dynamics::JointState& state) const;
  void restoreRamp(geometry::StateReader* reader);

  MotorSettings settings_;
  double initial_position_ = 0;
  JointSpline spline_;
  Mode mode_ = Mode::POSITION;
  double velocity_target_ = 0;  ///< adds to the spline's
  VelocityDrive ramp_;          ///< of DRIVE; its velocity is the one at command_time_
  double added_effort_ = 0;
  double integral_ = 0;              ///< [N m or N] the integral term, k_I times the integral of the error
  double command_time_ = 0;          ///< [s] of a velocity or an effort
  std::optional<FreeWay> free_way_;  ///< in the last (sub)step, if the joint had one
  // Variables of the present (sub)step, not state.
  JointSample sample_;
  double now_ = 0, dt_ = 0;
  double error_ = 0;
  double min_velocity_ = 0, max_velocity_ = 0;
  std::optional<double> given_effort_;
  bool capped_ = false;
};

}  // namespace blem_sim::sim
