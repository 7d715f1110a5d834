// One joint's motor: its commands, and the effort that follows from them.
#pragma once

#include <vector>

#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/sim/config.h"
#include "blem_sim/sim/trajectory.h"

namespace blem_sim {

struct MotorSettings {
  JointGains gains;
  MotorLaw law = MotorLaw::PID;
  JointFriction friction;
  double effort_limit = std::numeric_limits<double>::infinity();  ///< [N m or N]
  bool continuous = false;                                        ///< positions are meant to the nearest turn
  bool commanded = false;  ///< false: no motor of its own (a fixed joint, a mimic joint); friction stays
};

/** Follows a trajectory, holds a target, or keeps a velocity; an effort adds to each. State: trajectory, targets, integral term. */
class JointMotor {
 public:
  JointMotor() = default;
  JointMotor(const MotorSettings& settings, double initial_position);

  /** Makes the motor hold the initial position again, integral 0. */
  void reset();
  /** Takes over a trajectory's knots. @param position [rad or m] of the joint now, from which a velocity target is left */
  void follow(double now, double start, std::vector<JointSpline::Knot> knots, double position);
  void hold(double position, double velocity = 0);
  /** Velocity alone: damping against the velocity error, no stiffness; the integral and a trajectory's effort end. */
  void keepVelocity(double velocity);
  void addEffort(double effort) { added_effort_ = effort; }

  JointSample desired(double time) const;

  /** Latches the desired state for the coming (sub)step: Eq. 7 takes that at its start, the implicit law that at its end. */
  void sample(double time, double dt);
  /** Drive of the joint in the coming (sub)step, within the effort limit [Hauser 2013, Eq. 7 and 4.1]. */
  JointDrive drive(const JointState& state);
  /** Call after an accepted (sub)step: integrates, and notes whether the limit was met. @return true if it was */
  bool accept(const JointDrive& drive, const JointState& after, double dt);

  const MotorSettings& settings() const { return settings_; }
  void setViscousFriction(double friction) { settings_.friction.viscous = friction; }
  void append(std::vector<double>* numbers) const;
  void read(NumberReader* reader);

 private:
  MotorSettings settings_;
  double initial_position_ = 0;
  JointSpline spline_;
  bool velocity_only_ = false;
  double velocity_target_ = 0;  ///< adds to the spline's
  double added_effort_ = 0;
  double integral_ = 0;  ///< [N m or N] the integral term, k_I times the integral of the error
  // Variables of the present (sub)step, not state.
  JointSample sample_;
  double error_ = 0;
  bool capped_ = false;
};

}  // namespace blem_sim
