#include "controllers/limited_speed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <vector>

#include "geometry/random_shapes.h"

namespace blem_sim::sim {
namespace {

constexpr double STEP_TIME = 0.001;  // [s]
constexpr double ROUNDING = 1e-12;   // [m/s and their derivatives] beside limits

SpeedLimits limitsOf(double velocity, double acceleration, double jerk) {
  return {-velocity, velocity, -acceleration, acceleration, -jerk, jerk};
}

/** Number of steps until a speed is the wanted one; each is expected to keep the limits, and none to go beyond the wanted one. */
int stepsUntil(double wanted, const SpeedLimits& limits, LimitedSpeed* now) {
  int steps = 0;
  const double side = wanted - now->speed;
  while (now->speed != wanted && steps < 100000) {
    const LimitedSpeed next = speedAfterStep(*now, wanted, limits, STEP_TIME);
    EXPECT_LE(next.acceleration, limits.max_acceleration + ROUNDING);
    EXPECT_GE(next.acceleration, limits.min_acceleration - ROUNDING);
    EXPECT_LE((next.acceleration - now->acceleration) / STEP_TIME, limits.max_jerk + ROUNDING / STEP_TIME);
    EXPECT_GE((next.acceleration - now->acceleration) / STEP_TIME, limits.min_jerk - ROUNDING / STEP_TIME);
    EXPECT_GE((wanted - next.speed) * side, -ROUNDING);
    *now = next;
    ++steps;
  }
  return steps;
}

TEST(LimitedSpeed, WithoutLimitsFollowsAtOnce) {
  EXPECT_EQ(speedAfterStep({0.3, 5}, 0.7, {}, STEP_TIME).speed, 0.7);
  EXPECT_EQ(allowedSpeed(1e6, {}), 1e6);
}

TEST(LimitedSpeed, ChangesAtItsAcceleration) {
  const SpeedLimits limits = limitsOf(0.8, 2, SpeedLimits::NONE);
  EXPECT_EQ(allowedSpeed(-3, limits), -0.8);
  LimitedSpeed speed;
  EXPECT_NEAR(stepsUntil(0.8, limits, &speed), 0.8 / 2 / STEP_TIME, 1);
  EXPECT_NEAR(stepsUntil(-0.8, limits, &speed), 1.6 / 2 / STEP_TIME, 1);
}

TEST(LimitedSpeed, HasASignsOwnLimits) {
  SpeedLimits limits = limitsOf(1, 2, SpeedLimits::NONE);
  limits.min_acceleration = -4;
  LimitedSpeed speed;
  EXPECT_NEAR(stepsUntil(1, limits, &speed), 1 / 2.0 / STEP_TIME, 1);
  EXPECT_NEAR(stepsUntil(0, limits, &speed), 1 / 4.0 / STEP_TIME, 1);
}

TEST(LimitedSpeed, WithJerkTakesTheTimeOfTheQuickestRamp) {
  // Speed over acceleration, and acceleration over jerk; a small change has no time for the whole acceleration.
  const SpeedLimits limits = limitsOf(5, 1, 2);
  for (const auto& [change, seconds] : {std::make_pair(1.0, 1 / 1.0 + 1 / 2.0), std::make_pair(0.1, 2 * std::sqrt(0.1 / 2))}) {
    LimitedSpeed speed;
    EXPECT_NEAR(stepsUntil(change, limits, &speed) * STEP_TIME, seconds, 3 * STEP_TIME) << change;
    EXPECT_NEAR(stepsUntil(0, limits, &speed) * STEP_TIME, seconds, 3 * STEP_TIME) << change;
  }
}

TEST(LimitedSpeed, RampsBeginAndEndWithTheJerkOfThatSign) {
  SpeedLimits limits = limitsOf(5, 1, 2);
  limits.min_jerk = -4;
  LimitedSpeed speed;
  for (const double wanted : {1.0, 0.0})
    EXPECT_NEAR(stepsUntil(wanted, limits, &speed) * STEP_TIME, 1 / 1.0 + (1 / 2.0 + 1 / 4.0) / 2, 3 * STEP_TIME) << wanted;
}

TEST(LimitedSpeed, KeepsItsLimitsWhateverIsWanted) {
  geometry::RandomShapes random(7);
  SpeedLimits limits = limitsOf(1, 3, 20);
  limits.min_jerk = -50;
  LimitedSpeed speed;
  for (int command = 0; command < 200; ++command) {
    const double wanted = random.uniform(-1, 1);
    for (int step = 0; step < 40; ++step) {
      const LimitedSpeed next = speedAfterStep(speed, wanted, limits, STEP_TIME);
      ASSERT_LE(std::abs(next.acceleration), 3 + ROUNDING);
      const double jerk = (next.acceleration - speed.acceleration) / STEP_TIME;
      ASSERT_LE(jerk, 20 + 1e-6);
      ASSERT_GE(jerk, -50 - 1e-6);
      ASSERT_LE(std::abs(next.speed), 1 + ROUNDING) << command;
      speed = next;
    }
  }
}

}  // namespace
}  // namespace blem_sim::sim
