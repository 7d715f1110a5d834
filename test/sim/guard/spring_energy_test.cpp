// Energy of springs: what they store and give, and soft things that swing, roll and tumble without gaining any.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/cylinder_scene.h"
#include "sim/guard/booked_solves.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

/** Cubes that touch soft ground sink into it and swing, some leave it again. Those that have hardly a damper turn round 15 times in this
 * time, under sanitizers four times. */
TEST(EnergyGainedBit, IsNotSetBySpringsThatSwing) {
  for (const double mass : {0.1, 1.0, 5.0})
    for (const double stiffness : {5e3, 1e4, 1e5, 1e6})
      for (const double damping : {0.0, 1e-4 * stiffness, 0.06 * stiffness})
        for (const double height : {0.0, 0.05}) {
          SimulationConfig config = onGround({box("soft", Vector3::Constant(0.1), mass, {0, 0, 0.0525 + height})});
          config.contact.surface.stiffness = stiffness;
          config.contact.surface.damping = damping;
          EXPECT_EQ(statusOf(config, SANITIZED ? 0.125 : 0.5) & ENERGY_GAINED, 0u)
              << mass << " kg, " << stiffness << " N/m, " << damping << " N s/m, " << height << " m";
        }
}

/** A spring of 1e4 N/m below body 0 that is compressed by 1 mm, without a damper. */
dynamics::ContactConstraint compressedSpring(const Vector3& normal_BA) {
  dynamics::ContactConstraint spring;
  spring.body_a = 0;
  spring.normal_BA = normal_BA;
  spring.depth = 1e-3;
  spring.stiffness = 1e4;
  spring.damping = 0;
  return spring;
}

/** A corner turns about a body's centre of mass at 10 rad/s, so its spring is compressed, at the end by less than at the start. One that
 * rolls ends where its contact is found. */
TEST(EnergyBalance, SpringsEndAtTheirPointsOrWhereTheyAreFound) {
  HandMadeSolve solve(1);
  dynamics::ContactConstraint spring = compressedSpring(Vector3::UnitZ());
  spring.point = {0.1, 0, -0.1};
  solve.contacts.constraints = {spring};
  solve.contacts.solved.resize(1);
  solve.contacts.solved[0].id = 7;
  solve.force = {0, 0, 10};
  solve.before[0].w_WB = solve.after[0].w_WB = {0, 10, 0};
  solve.after[0].X_WB.linear() = Eigen::AngleAxisd(10 * BALANCE_STEP, Vector3::UnitY()).toRotationMatrix();
  const auto stored = [](double depth, double speed) { return 0.5e4 * std::pow(depth + 0.5 * BALANCE_STEP * speed, 2); };
  const Vector3 ended = solve.after[0].X_WB * spring.point;
  EXPECT_NEAR(solve.gain().total, stored(1e-3 + spring.point.z() - ended.z(), -10 * ended.x()) - stored(1e-3, -1), 1e-12);
  solve.contacts.constraints[0].rolling = 0.1;
  contact::Contact found;
  found.id = 7;
  found.point = {0.05, 0, -0.1};
  found.normal_BA = Vector3::UnitZ();
  found.depth = 1.7e-3;
  solve.end.resize(1);
  solve.end[0].a = solve.contacts.solved[0].collider_a;
  solve.end[0].b = solve.contacts.solved[0].collider_b;
  solve.end[0].contacts = {found};
  EXPECT_NEAR(solve.gain().total, stored(1.7e-3, -0.5) - stored(1e-3, -1), 1e-12);
}

/** A damper gives energy if it takes its speed from a rim's point that rolls away from the ground. */
TEST(EnergyGainedBit, IsNotSetByCoinsThatRollOnSprings) {
  for (const double friction : {0.1, 0.5})
    for (const double lean : {0.2, 0.3, 0.4, 0.5})
      for (const double damping : {2e2, 2e4}) {
        SimulationConfig config = roundConfig(friction, 0.0025);
        config.environments = {ground()};
        config.contact.surface.stiffness = 3e5;
        config.contact.surface.damping = damping;
        config.objects = {cylinderAlongY("coin", {0.09, 0.01, 0.3}, {0, 0, 0.1})};
        config.objects[0].X_WO.linear() = Eigen::AngleAxisd(lean, Vector3::UnitX()) * config.objects[0].X_WO.linear();
        config.objects[0].linear_velocity = {1, 0, 0};
        config.objects[0].angular_velocity = {0, 12, 0};
        EXPECT_EQ(statusOf(config, SANITIZED ? 0.15 : 0.6) & ENERGY_GAINED, 0u)
            << friction << ", " << lean << " rad, " << damping << " N s/m";
      }
}

/** Corners turn while springs below them hold and let go. */
TEST(EnergyGainedBit, IsNotSetByCubesThatTumbleOnSprings) {
  for (int i = 0; i < 24; i += SANITIZED ? 4 : 1) {
    SimulationConfig config = onGround({box("soft", Vector3::Constant(0.2), 1, {0, 0, 0.25})});
    config.contact.surface.stiffness = 4e4;
    config.contact.surface.damping = 2e3;
    config.objects[0].X_WO.linear() = Eigen::AngleAxisd(0.5 * i, Vector3(1, 0.1 * i, 0.5).normalized()).toRotationMatrix();
    config.objects[0].linear_velocity = {1.5, 0, 0};
    config.objects[0].angular_velocity = {-10, 15, 1.0 * i};
    EXPECT_EQ(statusOf(config, 1) & ENERGY_GAINED, 0u) << i;
  }
}

/**
 * A spring of 1e4 N/m that was compressed by 1 mm holds 5 mJ: what leaves it within a step at a speed of 0.07 m/s has taken 4.9 mJ of them,
 * at 0.1 m/s 10 mJ.
 */
TEST(EnergyBalance, ASpringGivesNoMoreThanItHolds) {
  HandMadeSolve solve(1);
  solve.contacts.constraints = {compressedSpring(Vector3::UnitX())};
  solve.contacts.solved.resize(1);
  for (const double speed : {0.07, 0.1}) {
    solve.after[0].v_WCom = {speed, 0, 0};
    solve.after[0].X_WB.translation() = solve.before[0].X_WB.translation() + Vector3(2e-3, 0, 0);
    solve.force = {2 * speed / BALANCE_STEP, 0, 0};
    EXPECT_NEAR(solve.gain().out_of_nothing, std::max(0.0, speed * speed - 5e-3), 1e-5) << speed;
  }
}

}  // namespace
}  // namespace blem_sim::sim
