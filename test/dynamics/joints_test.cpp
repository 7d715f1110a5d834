// Joints: kinematics, limits, wrenches.
#include <gtest/gtest.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"
#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

JointSpec jointSpec(JointKind kind, int parent, int child, const Pose& X_PJ, const Vector3& axis) {
  JointSpec spec;
  spec.name = "joint";
  spec.kind = kind;
  spec.parent = parent, spec.child = child;
  spec.X_PJ = X_PJ;
  spec.axis = axis;
  return spec;
}

/** A bar of 1 m and 1 kg from the origin along x, its frame at the joint. */
BodySpec bar(double length = 1, double mass = 1) {
  BodySpec spec = boxBody("bar", mass, {length, 0.02, 0.02}, Vector3::Zero());
  spec.inertial.com = {length / 2, 0, 0};
  return spec;
}

TEST(Joints, PendulumKeepsItsEnergyAndPeriod) {
  World world(GRAVITY, {});
  const int body = world.addBody(bar());
  const int hinge = world.addJoint(jointSpec(JointKind::REVOLUTE, WORLD_BODY, body, Pose::Identity(), Vector3::UnitY()));
  const double I = world.bodySpec(body).inertial.inertia(1, 1) + 0.25;
  const double start = world.potentialEnergy();
  // Reference: the same semi-implicit step in the joint's own coordinate.
  double q = 0, v = 0;
  for (int i = 0; i < 2000; ++i) {
    world.step(DT, {}, {JointDrive()});
    v += DT * 9.81 * 0.5 * std::cos(q) / I;
    q += DT * v;
  }
  EXPECT_NEAR(world.jointState(hinge).position, q, 2e-3);
  EXPECT_NEAR(world.kineticEnergy() + world.potentialEnergy(), start, 0.02);
  EXPECT_LT(world.bodyState(body).X_WB.translation().norm(), 1e-5);
}

TEST(Joints, FullTurnsAreCounted) {
  World world(Vector3::Zero(), {});
  const int body = world.addBody(bar());
  const int hinge = world.addJoint(jointSpec(JointKind::REVOLUTE, WORLD_BODY, body, makePose({0, 0, 0}), Vector3::UnitZ()), 0.5);
  JointDrive drive;
  drive.damping = 1e6;
  drive.target_velocity = 7;
  for (int i = 0; i < 3000; ++i) world.step(DT, {}, {drive});
  EXPECT_NEAR(world.jointState(hinge).position, 21.5, 2e-3);
  EXPECT_NEAR(world.jointState(hinge).velocity, 7, 1e-6);
  world.resetJointPosition(hinge, world.jointState(hinge).position - 4 * M_PI);
  EXPECT_NEAR(world.jointState(hinge).position, 21.5 - 4 * M_PI, 2e-3);
}

/** A rotor at 60,000 turns a minute: a whole turn in each step of 1 ms, which its poses do not show. */
TEST(Joints, FullTurnsOfFastRotorsAreCounted) {
  constexpr double SPEED = 1000 * 2 * M_PI;
  for (const char* stepper : {"articulated", "world_step", "quick_step"}) {
    SolverSettings settings;
    settings.stepper = stepper;
    World world(Vector3::Zero(), settings);
    const int body = world.addBody(boxBody("rotor", 1, {0.1, 0.1, 0.02}, Vector3::Zero()));
    const int hinge = world.addJoint(jointSpec(JointKind::REVOLUTE, WORLD_BODY, body, Pose::Identity(), Vector3::UnitZ()));
    for (const double way : {1.0, -0.7}) {
      BodyState spinning;
      spinning.w_WB.z() = way * SPEED;
      world.setBodyState(body, spinning);
      world.resetJointPosition(hinge, 0);
      for (int i = 0; i < 100; ++i) world.step(DT, {}, {JointDrive()});
      EXPECT_NEAR(world.jointState(hinge).position, way * SPEED * 100 * DT, 1e-6) << stepper;
    }
  }
}

TEST(Joints, PrismaticMovesAlongItsAxisOnATurningParent) {
  World world(Vector3::Zero(), {});
  const int arm = world.addBody(bar(1, 5)), carriage = world.addBody(boxBody("carriage", 1, {0.1, 0.1, 0.1}, {0.5, 0, 0.2}));
  world.addJoint(jointSpec(JointKind::REVOLUTE, WORLD_BODY, arm, Pose::Identity(), Vector3::UnitZ()));
  const int slider = world.addJoint(jointSpec(JointKind::PRISMATIC, arm, carriage, makePose({0.5, 0, 0.2}), Vector3::UnitX()));
  JointDrive turn, push;
  turn.damping = push.damping = 1e7;
  turn.target_velocity = 1, push.target_velocity = 0.1;
  for (int i = 0; i < 1000; ++i) world.step(DT, {}, {turn, push});
  EXPECT_NEAR(world.jointState(slider).position, 0.1, 1e-4);
  EXPECT_NEAR(world.jointState(slider).velocity, 0.1, 2e-4);  // the arm turns on by dt after the motor has had its say
  const Vector3 p = world.bodyState(arm).X_WB.inverse() * world.bodyState(carriage).X_WB.translation();
  EXPECT_NEAR((p - Vector3(0.6, 0, 0.2)).norm(), 0, 1e-4);
}

class Limits : public ::testing::TestWithParam<JointKind> {};

TEST_P(Limits, StopUnderLoadWithoutOvershoot) {
  for (const double sign : {-1.0, 1.0}) {
    World world(Vector3::Zero(), {});
    const int body = world.addBody(bar());
    JointSpec spec = jointSpec(GetParam(), WORLD_BODY, body, Pose::Identity(), Vector3::UnitY());
    spec.lower = -0.3, spec.upper = 0.3;
    const int joint = world.addJoint(spec);
    JointDrive drive;
    drive.effort = 5 * sign;
    double furthest = 0;
    for (int i = 0; i < 1000; ++i) {
      world.step(DT, {}, {drive});
      furthest = std::max(furthest, sign * world.jointState(joint).position);
    }
    EXPECT_LT(furthest, 0.3 + 1e-9);
    EXPECT_NEAR(world.jointState(joint).position, 0.3 * sign, 1e-9);
    EXPECT_NEAR(world.jointState(joint).effort, 5 * sign, 1e-12);  // the stop is not the motor
    // The stop lets go.
    drive.effort = -5 * sign;
    for (int i = 0; i < 50; ++i) world.step(DT, {}, {drive});
    EXPECT_LT(sign * world.jointState(joint).position, 0.299);
  }
}

TEST_P(Limits, MotorPushingIntoTheStopStaysWithinItsEffort) {
  World world(Vector3::Zero(), {});
  const int body = world.addBody(bar());
  JointSpec spec = jointSpec(GetParam(), WORLD_BODY, body, Pose::Identity(), Vector3::UnitY());
  spec.lower = 0, spec.upper = 0.1;
  const int joint = world.addJoint(spec);
  JointDrive drive;
  drive.stiffness = 1e4, drive.damping = 100, drive.target_position = 1, drive.max_effort = 20;
  drive.dry_friction = 2;
  for (int i = 0; i < 1000; ++i) world.step(DT, {}, {drive});
  EXPECT_NEAR(world.jointState(joint).position, 0.1, 1e-8);
  EXPECT_NEAR(world.jointState(joint).effort, 20, 1e-9) << "friction and the stop are not the motor";
  EXPECT_NEAR(world.jointState(joint).velocity, 0, 1e-9);
}

TEST_P(Limits, EqualLimitsHold) {
  World world(GRAVITY, {});
  const int body = world.addBody(bar());
  JointSpec spec = jointSpec(GetParam(), WORLD_BODY, body, Pose::Identity(), Vector3(0, 1, 1).normalized());
  spec.lower = spec.upper = 0;
  const int joint = world.addJoint(spec);
  for (int i = 0; i < 1000; ++i) world.step(DT, {}, {JointDrive()});
  EXPECT_NEAR(world.jointState(joint).position, 0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Limits, ::testing::Values(JointKind::REVOLUTE, JointKind::PRISMATIC));

TEST(Joints, RemovedBodyTakesItsJoints) {
  World world(GRAVITY, {});
  const int a = world.addBody(bar()), b = world.addBody(bar());
  world.addJoint(jointSpec(JointKind::FIXED, WORLD_BODY, a, Pose::Identity(), Vector3::UnitZ()));
  world.addJoint(jointSpec(JointKind::REVOLUTE, a, b, Pose::Identity(), Vector3::UnitY()));
  world.removeBody(a);
  EXPECT_EQ(world.bodyCount(), 2);
  EXPECT_EQ(world.jointCount(), 2);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(world.step(DT, {}, {JointDrive(), JointDrive()}).finite);
  EXPECT_NEAR(world.bodyState(b).v_WCom.z(), -0.981, 1e-12);
  EXPECT_EQ(world.addBody(bar()), 0);  // its slot is used again
}

TEST(Joints, BadSpecsAreRefused) {
  World world(GRAVITY, {});
  const int a = world.addBody(bar());
  EXPECT_THROW(world.addJoint(jointSpec(JointKind::FIXED, 7, a, Pose::Identity(), Vector3::UnitZ())), InputError);
  EXPECT_THROW(world.addJoint(jointSpec(JointKind::FIXED, a, a, Pose::Identity(), Vector3::UnitZ())), InputError);
  EXPECT_THROW(world.addJoint(jointSpec(JointKind::REVOLUTE, WORLD_BODY, a, Pose::Identity(), Vector3::Zero())), InputError);
  BodySpec massless = bar();
  massless.inertial.mass = 0;
  EXPECT_THROW(world.addBody(massless), InputError);
  BodySpec flat = bar();
  flat.inertial.inertia(0, 0) = -1;
  EXPECT_THROW(world.addBody(flat), InputError);
  SolverSettings settings;
  settings.stepper = "magic";
  EXPECT_THROW(World(GRAVITY, settings), InputError);
}

}  // namespace
}  // namespace blem_sim::dynamics
