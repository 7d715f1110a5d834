// Speeds that follow a wanted one within limits of speed, acceleration and jerk.
#pragma once

#include "blem_sim/sim/controller_config.h"

namespace blem_sim::sim {

/** A speed and its change. */
struct LimitedSpeed {
  double speed = 0;         ///< [m/s or rad/s]
  double acceleration = 0;  ///< [m/s^2 or rad/s^2] of the step before
};

/** The nearest speed that the limits allow. */
double allowedSpeed(double wanted, const SpeedLimits& limits);

/**
 * The speed a step of dt [s] later: on its way to a wanted one that is allowed, as fast as the limits let it. With limits of jerk the
 * acceleration ends where the speed is reached, so that it is not overshot.
 */
LimitedSpeed speedAfterStep(const LimitedSpeed& now, double wanted, const SpeedLimits& limits, double dt);

}  // namespace blem_sim::sim
