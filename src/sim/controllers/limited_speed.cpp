#include "controllers/limited_speed.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::sim {
namespace {

/**
 * The largest acceleration that, falling by `fall` in every step after this one, ends when the speed has changed by `change`: n + 1 steps
 * change it by dt ((n + 1) a - n (n + 1) fall / 2).
 */
double endingAcceleration(double change, double fall, double dt) {
  const double per_step = std::abs(change) / dt;
  if (std::isinf(fall)) return change / dt;
  const double steps = std::floor((std::sqrt(1 + 8 * per_step / fall) - 1) / 2);
  return std::copysign(per_step / (steps + 1) + steps * fall / 2, change);
}

}  // namespace

double allowedSpeed(double wanted, const SpeedLimits& limits) { return std::clamp(wanted, limits.min_velocity, limits.max_velocity); }

LimitedSpeed speedAfterStep(const LimitedSpeed& now, double wanted, const SpeedLimits& limits, double dt) {
  const double change = wanted - now.speed;
  const double fall = dt * (change > 0 ? -limits.min_jerk : limits.max_jerk);
  const double ending = endingAcceleration(change, fall, dt);
  const double bounded = std::clamp(ending, limits.min_acceleration, limits.max_acceleration);
  const double acceleration = std::clamp(bounded, now.acceleration + limits.min_jerk * dt, now.acceleration + limits.max_jerk * dt);
  const bool is_last = acceleration == change / dt;
  return {is_last ? wanted : now.speed + acceleration * dt, acceleration};
}

}  // namespace blem_sim::sim
