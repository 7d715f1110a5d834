// Impulse of one joint as a function of its velocity: motor, friction and limits, each piecewise linear and falling.
#pragma once

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {

struct JointResponse {
  double impulse = 0, stiffness = 0;  ///< the second: -d impulse / dv >= 0

  bool operator==(const JointResponse& o) const { return impulse == o.impulse && stiffness == o.stiffness; }
};

/** A straight piece of a motor's law. */
struct MotorPiece {
  double gain = 0, velocity = 0;

  /** p = gain (velocity - v - response p) */
  double impulse(double v, double response = 0) const { return gain * (velocity - v) / (1 + gain * response); }
};

/** Units for a revolute joint; a prismatic one has N s and m/s. */
struct JointTerm {
  static constexpr double STICKING = 1 - 1e-9;  ///< of the bound: friction that was remembered below it had stuck

  int dof = -1;           ///< of the forest
  int joint = -1;         ///< of the world; -1: the dof is a free root's
  int root_drive = -1;    ///< of the step's input; -1: the dof is a joint's
  double motor_gain = 0;  ///< D [N m s^2/rad]: impulse D (motor_velocity - v), within +-motor_bound
  double motor_velocity = 0;
  double motor_bound = 0;
  double velocity_gain = 1;  ///< impulse at most velocity_gain (max_velocity - v), at least velocity_gain (min_velocity - v)
  double min_velocity = -INFINITY, max_velocity = INFINITY;
  double viscous = 0;   ///< h mu_V
  double lead = 0;      ///< by which the joint is faster in the middle of a fast tree's free way than where it sets out
  double softness = 1;  ///< divides the gains of friction and limits
  double dry_gain = 0;  ///< impulse dry_previous - dry_gain / softness * v, within +-dry_bound
  double dry_previous = 0;
  double dry_bound = 0;
  double limit_gain = 0;                          ///< 0: no limits
  double lower_velocity = 0, lower_previous = 0;  ///< impulse max(0, lower_previous + limit_gain / softness * (lower_velocity - v))
  double upper_velocity = 0, upper_previous = 0;  ///< impulse -max(0, upper_previous + limit_gain / softness * (v - upper_velocity))

  /**
   * Velocity that the motor wants, and how stiffly: its law, or the end of its velocities that lies before that. At v + response p, if that
   * is where its impulse p leads: each piece falls, so that the smaller of two has the smaller solution.
   * @param response [1/kg or 1/(kg m^2)] of the velocity to an impulse; 0: at v
   */
  MotorPiece motorPiece(double v, double response = 0) const {
    const MotorPiece law{motor_gain, motor_velocity}, most{velocity_gain, max_velocity}, least{velocity_gain, min_velocity};
    const double wanted = law.impulse(v, response);
    if (wanted > most.impulse(v, response)) return most;
    return wanted < least.impulse(v, response) ? least : law;
  }
  double motorImpulse(double v, double response = 0) const {
    return std::clamp(motorPiece(v, response).impulse(v, response), -motor_bound, motor_bound);
  }
  /** The motor's impulse about v, or about where it leads, as a straight line: impulse - stiffness * velocity. */
  JointResponse motorLine(double v, double response = 0) const {
    const MotorPiece piece = motorPiece(v, response);
    const double wanted = piece.impulse(v, response);
    if (wanted > motor_bound) return {motor_bound, 0};
    if (wanted < -motor_bound) return {-motor_bound, 0};
    return {piece.gain * piece.velocity, piece.gain};
  }
  /** Lets motor and viscous friction answer to the velocity v + lead; what friction has of the lead is viscousLead. */
  void setLead(double faster) {
    lead = faster;
    motor_velocity -= lead;
  }
  double viscousLead() const { return -viscous * lead; }
  double dryImpulse(double v) const { return std::clamp(dry_previous - dry_gain / softness * v, -dry_bound, dry_bound); }
  double lowerImpulse(double v) const {
    return limit_gain > 0 ? std::max(0.0, lower_previous + limit_gain / softness * (lower_velocity - v)) : 0;
  }
  double upperImpulse(double v) const {
    return limit_gain > 0 ? std::max(0.0, upper_previous + limit_gain / softness * (v - upper_velocity)) : 0;
  }
  double impulse(double v) const { return motorImpulse(v) - viscous * v + dryImpulse(v) + lowerImpulse(v) - upperImpulse(v); }

  /** -d impulse / dv >= 0 */
  double stiffness(double v) const {
    double sum = viscous + motorLine(v).stiffness;
    if (std::abs(dry_previous - dry_gain / softness * v) < dry_bound) sum += dry_gain / softness;
    if (lowerImpulse(v) > 0) sum += limit_gain / softness;
    if (upperImpulse(v) > 0) sum += limit_gain / softness;
    return sum;
  }

  /** The same, friction and limits being extended linearly from where the proximal point's impulses belong to. */
  JointResponse expect(double v) const {
    JointResponse out{motorImpulse(v) - viscous * v + dry_previous, viscous};
    const auto add = [&](double gain, double speed) {
      out.impulse -= gain * speed;
      out.stiffness += gain;
    };
    out.stiffness += motorLine(v).stiffness;
    if (std::abs(dry_previous) < STICKING * dry_bound) add(dry_gain / softness, v);
    if (lower_previous > 0) {
      out.impulse += lower_previous;
      add(limit_gain / softness, v - lower_velocity);
    }
    if (upper_previous > 0) {
      out.impulse -= upper_previous;
      add(limit_gain / softness, v - upper_velocity);
    }
    return out;
  }

  /** Speed [rad/s or m/s] by which friction that sticks still creeps, or a limit that pushes is still missed. */
  double creep(double v) const {
    double worst = 0;
    if (dry_gain > 0 && std::abs(dry_previous - dry_gain / softness * v) < dry_bound) worst = std::abs(v);
    if (lowerImpulse(v) > 0) worst = std::max(worst, std::abs(lower_velocity - v));
    if (upperImpulse(v) > 0) worst = std::max(worst, std::abs(v - upper_velocity));
    return worst;
  }

  /** Takes the impulses at v as the next proximal point. */
  void remember(double v) {
    const double dry = dryImpulse(v), lower = lowerImpulse(v), upper = upperImpulse(v);
    dry_previous = dry;
    lower_previous = lower;
    upper_previous = upper;
  }
};

}  // namespace blem_sim::dynamics
