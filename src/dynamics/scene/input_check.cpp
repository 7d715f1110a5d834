#include "scene/input_check.h"

#include <cmath>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::dynamics {
namespace {

constexpr double UNIT = 1e-3;  // largest difference of a normal's length from 1

bool finiteAndNotNegative(double x) { return x >= 0 && std::isfinite(x); }

}  // namespace

bool isSound(const ContactConstraint& c) {
  return c.point.allFinite() && std::abs(c.normal_BA.squaredNorm() - 1) < 2 * UNIT && std::isfinite(c.depth) && c.friction >= 0 &&
         c.restitution >= 0 && c.impact_friction_factor >= 0 && c.impact_friction_speed >= 0 && c.stiffness >= 0 && c.damping >= 0;
}

bool isSound(const JointDrive& d) {
  return std::isfinite(d.effort) && std::isfinite(d.outside_effort) && std::isfinite(d.target_position) &&
         std::isfinite(d.target_velocity) && d.max_effort >= 0 && d.min_velocity <= d.max_velocity && d.velocity_gain >= 0 &&
         finiteAndNotNegative(d.stiffness) && finiteAndNotNegative(d.damping) && finiteAndNotNegative(d.dry_friction) &&
         finiteAndNotNegative(d.viscous_friction);
}

bool isSound(const RootDrive& d) {
  return d.velocity.allFinite() && std::isfinite(d.spin) && finiteAndNotNegative(d.max_force) && finiteAndNotNegative(d.max_torque);
}

void checkJointNumbers(const JointSpec& joint, double position) {
  const std::string where = "joint '" + joint.name + "': ";
  if (!joint.X_PJ.matrix().allFinite()) throw InputError(where + "its frame is not finite; correct its origin");
  if (std::isnan(joint.lower) || std::isnan(joint.upper)) throw InputError(where + "a limit is not a number; correct lower and upper");
  if (!std::isfinite(joint.mimic_multiplier) || !std::isfinite(joint.mimic_offset))
    throw InputError(where + "mimic is not finite; correct its multiplier and offset");
  if (!finiteAndNotNegative(joint.armature)) throw InputError(where + "armature must be finite and at least 0");
  if (!std::isfinite(position)) throw InputError(where + "its position is not finite; give it a number");
}

}  // namespace blem_sim::dynamics
