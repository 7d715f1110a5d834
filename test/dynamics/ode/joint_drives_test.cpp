// Motors and joint friction against theory.
#include <gtest/gtest.h>

#include <algorithm>

#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

/** One body on one joint to the world, no gravity. */
struct OneJoint {
  OneJoint(JointKind kind, double mass, double inertia, const Vector3& gravity = Vector3::Zero()) : world(gravity, {}) {
    BodySpec body;
    body.name = "body";
    body.inertial.mass = mass;
    body.inertial.inertia = inertia * Matrix3::Identity();
    world.addBody(body);
    JointSpec spec;
    spec.name = "joint";
    spec.kind = kind;
    world.addJoint(spec);
  }
  void run(int steps, const JointDrive& drive) {
    for (int i = 0; i < steps; ++i) {
      last = &world.step(DT, {}, {drive});
      ASSERT_TRUE(last->finite);
      lcp_errors += last->lcp_errors;
    }
  }
  const SolveResult& result() const { return *last; }
  JointState state() const { return world.jointState(0); }

  World world;
  const SolveResult* last = nullptr;
  int lcp_errors = 0;
};

class Drives : public ::testing::TestWithParam<JointKind> {
 protected:
  OneJoint joint() const { return OneJoint(GetParam(), 1, 1); }
};

TEST_P(Drives, EffortGivenInAdvance) {
  OneJoint one(GetParam(), 2, 2);
  JointDrive drive;
  drive.effort = 3;
  one.run(1000, drive);
  EXPECT_NEAR(one.state().velocity, 1.5, 1e-10);
  EXPECT_NEAR(one.state().effort, 3, 1e-12);
}

// One step is the solution of I (v+ - v)/h = k (target - q - h v+) + d (target_v - v+).
TEST_P(Drives, ImplicitPdIsExactlyThatEquation) {
  OneJoint one(GetParam(), 2, 2);
  JointDrive drive;
  drive.stiffness = 400, drive.damping = 30, drive.target_position = 0.3, drive.target_velocity = 0.2;
  double q = 0, v = 0;
  for (int i = 0; i < 300; ++i) {
    one.run(1, drive);
    v = (2 * v / DT + 400 * (0.3 - q) + 30 * 0.2) / (2 / DT + DT * 400 + 30);
    q += DT * v;
    ASSERT_NEAR(one.state().velocity, v, 1e-9);
    ASSERT_NEAR(one.state().position, q, 1e-9);
    ASSERT_NEAR(one.state().effort, 400 * (0.3 - q) + 30 * (0.2 - v), 1e-6);
  }
}

TEST_P(Drives, EffortLimitSaturates) {
  OneJoint one(GetParam(), 1, 1);
  JointDrive drive;
  drive.stiffness = 1e6, drive.damping = 1e3, drive.target_position = 10, drive.max_effort = 5;
  one.run(500, drive);
  EXPECT_NEAR(one.state().effort, 5, 1e-12);
  EXPECT_NEAR(one.state().velocity, 2.5, 1e-9);
}

TEST_P(Drives, DryFrictionSticksBelowAndSlipsAbove) {
  OneJoint one(GetParam(), 1, 1);
  JointDrive drive;
  drive.dry_friction = 2;
  drive.effort = 1.99;
  one.run(1000, drive);
  EXPECT_LT(std::abs(one.state().position), 1e-8);
  EXPECT_EQ(one.state().effort, 1.99);
  EXPECT_NEAR(one.result().axis_efforts[0], 0, 1e-6);  // friction takes up the motor's effort
  drive.effort = 2.5;
  const double before = one.state().velocity;
  one.run(1000, drive);
  EXPECT_NEAR(one.state().velocity - before, 0.5, 1e-8);
  EXPECT_EQ(one.state().effort, 2.5);
  EXPECT_NEAR(one.result().axis_efforts[0], 0.5, 1e-9);
  EXPECT_EQ(one.lcp_errors, 0);
}

TEST_P(Drives, DryFrictionStopsAMovingJoint) {
  OneJoint one(GetParam(), 1, 1);
  JointDrive push;
  push.effort = 1;
  one.run(1000, push);
  JointDrive friction;
  friction.dry_friction = 4;
  one.run(200, friction);
  EXPECT_NEAR(one.state().velocity, 0.2, 1e-9);
  one.run(200, friction);
  EXPECT_NEAR(one.state().velocity, 0, 1e-9);
}

TEST_P(Drives, ViscousFrictionDecays) {
  OneJoint one(GetParam(), 1, 1);
  JointDrive push;
  push.effort = 1;
  one.run(1000, push);
  JointDrive viscous;
  viscous.viscous_friction = 3;
  one.run(500, viscous);
  EXPECT_NEAR(one.state().velocity, std::pow(1 / (1 + DT * 3), 500), 1e-9);
  // Stiff: 3000 times the friction at which an explicit torque is stable.
  viscous.viscous_friction = 6e6;
  one.run(10, viscous);
  EXPECT_NEAR(one.state().velocity, 0, 1e-9);
}

TEST_P(Drives, AllTermsTogetherBalance) {
  OneJoint one(GetParam(), 1, 1);
  JointDrive drive;
  drive.effort = 10, drive.dry_friction = 2, drive.viscous_friction = 4;
  drive.damping = 1, drive.target_velocity = 0, drive.max_effort = 0.5;
  one.run(20000, drive);
  // 10 = 2 + 4 v + min(v, 0.5)
  EXPECT_NEAR(one.state().velocity, 7.5 / 4, 1e-6);
  EXPECT_NEAR(one.state().effort, 10 - 0.5, 1e-9);
  EXPECT_NEAR(one.result().axis_efforts[0], 0, 1e-5);
}

// A spring that pulls against friction: less than it holds, then more. The motor's effort is its law's.
TEST_P(Drives, EffortIsTheMotorsAlone) {
  for (const double friction : {25.0, 15.0}) {
    OneJoint one(GetParam(), 1, 1);
    JointDrive drive;
    drive.stiffness = 20, drive.damping = 2, drive.target_position = 1;
    drive.dry_friction = friction, drive.viscous_friction = 3, drive.outside_effort = 0.5;
    one.run(40, drive);
    const JointState now = one.state();
    EXPECT_EQ(friction > 20.5, std::abs(now.velocity) < 1e-6) << friction;
    EXPECT_NEAR(now.effort, 20 * (1 - now.position) - 2 * now.velocity, 1e-6) << friction;
    const double held = friction > 20.5 ? 0 : now.effort + 0.5 - friction - 3 * now.velocity;
    EXPECT_NEAR(one.result().axis_efforts[0], held, 1e-5) << friction;
  }
}

TEST_P(Drives, EffortOfAnImplicitMotorAtItsLimit) {
  OneJoint one(GetParam(), 1, 1);
  JointDrive drive;
  drive.stiffness = 1e5, drive.damping = 1e3, drive.target_position = 1, drive.max_effort = 6, drive.dry_friction = 2;
  one.run(10, drive);
  EXPECT_NEAR(one.state().effort, 6, 1e-9);
  EXPECT_NEAR(one.result().axis_efforts[0], 4, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Drives, ::testing::Values(JointKind::REVOLUTE, JointKind::PRISMATIC));

// A 20 g finger link: the explicit law diverges at gains the implicit one does not notice.
TEST(Drives, StiffGainsOnALightLink) {
  for (const double kp : {1.0, 1e2, 1e4, 1e6})
    for (const double zeta : {0.1, 1.0, 5.0}) {
      const double inertia = 1.09e-5, kd = 2 * zeta * std::sqrt(kp * inertia);
      OneJoint one(JointKind::REVOLUTE, 0.02, inertia, {0, 0, -9.81});
      JointDrive drive;
      drive.stiffness = kp, drive.damping = kd, drive.target_position = 0.5;
      one.run(2000, drive);
      EXPECT_NEAR(one.state().position, 0.5, 1e-6) << kp << " " << zeta;
      EXPECT_LT(std::abs(one.state().velocity), 1e-5) << kp << " " << zeta;
    }
  OneJoint one(JointKind::REVOLUTE, 0.02, 1.09e-5);
  double fastest = 0;
  for (int i = 0; i < 50; ++i) {
    JointDrive drive;
    drive.effort = 1e2 * (0.5 - one.state().position) - 0.033 * one.state().velocity;
    one.run(1, drive);
    fastest = std::max(fastest, std::abs(one.state().velocity));
  }
  EXPECT_GT(fastest, 1e4);
}

}  // namespace
}  // namespace blem_sim::dynamics
