// Impacts against what joints hold: arms on their stops, and wheels that a mimic joint gears to what is hit.
#include <gtest/gtest.h>

#include "dynamics/bouncing_bodies.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

constexpr double BALL = 0.2, SPEED = 3, LEVER = 0.4, E = 0.8;  // [kg], [m/s], [m]
constexpr double RADIUS = 0.03;                                // [m] of what meets

Surface bouncing() {
  Surface surface;
  surface.restitution = E;
  surface.friction = 0;
  return surface;
}

/** A ball flies along x at a ball that a lever of some inertia carries below its hinge. */
struct HitLever {
  explicit HitLever(double mass, double lower = -INFINITY) : scene(Vector3::Zero(), bouncing()) {
    lever = scene.add(mass, Vector3::Constant(1e-6), {0, 0, -LEVER}, {{Vector3::Zero(), RADIUS}});
    JointSpec hinge;
    hinge.name = "hinge";
    hinge.child = lever;
    hinge.axis = Vector3::UnitY();
    hinge.lower = lower;
    hinge.X_PJ = Pose::Identity();
    scene.world.addJoint(hinge, 0);
    ball = scene.addSphere(BALL, RADIUS, {-0.2, 0, -LEVER});
    scene.setVelocity(ball, SPEED * Vector3::UnitX(), Vector3::Zero());
    inertia = 1e-6 + mass * LEVER * LEVER;
  }
  /** A wheel that turns so many times as far. */
  void gear(double multiplier, double wheel_inertia) {
    JointSpec axle;
    axle.name = "axle";
    axle.child = scene.add(1, Vector3::Constant(wheel_inertia), {0, 0.5, 0}, {});
    axle.axis = Vector3::UnitY();
    axle.X_PJ = makePose({0, 0.5, 0});
    axle.mimic_joint = 0;
    axle.mimic_multiplier = multiplier;
    scene.world.addJoint(axle, 0);
    inertia += multiplier * multiplier * wheel_inertia;
  }
  /** @return [N s] that the lever's hinge took along x */
  double fly() {
    double taken = 0;
    std::vector<JointDrive> drives(scene.world.jointCount());
    drives[0] = drive;
    for (int i = 0; i < 150; ++i) {
      scene.findContacts(DT);
      taken += DT * scene.world.step(DT, scene.contacts, drives).joint_wrenches[0].force.x();
    }
    return taken;
  }
  double ballSpeed() const { return scene.world.bodyState(ball).v_WCom.x(); }

  BouncingBodies scene;
  int lever = 0, ball = 0;
  JointDrive drive;  ///< of the lever
  double inertia = 0;
};

// It gave way, and the ball kept nothing or all but nothing of its speed.
TEST(HeldImpacts, AnArmOnItsStopIsAWall) {
  for (const double mass : {0.01, 0.2, 20.0})
    for (const double pressed : {0.0, 1.0}) {
      HitLever hit(mass, 0);
      hit.drive.outside_effort = -pressed;
      EXPECT_NEAR(hit.fly(), -(1 + E) * BALL * SPEED, 1e-5) << mass << " kg, " << pressed << " N m";
      EXPECT_NEAR(hit.ballSpeed(), -E * SPEED, 1e-5) << mass << " kg, " << pressed << " N m";
      EXPECT_NEAR(hit.scene.world.jointState(0).velocity, 0, 1e-6) << mass << " kg, " << pressed << " N m";
    }
}

// The wheel's inertia was found by the solve, after the bounce.
TEST(HeldImpacts, WhatMimicsIsPartOfTheMassThatIsHit) {
  for (const double multiplier : {-3.0, 0.5, 10.0}) {
    HitLever hit(0.5);
    hit.gear(multiplier, 0.02);
    hit.fly();
    const double impulse = (1 + E) * SPEED / (1 / BALL + LEVER * LEVER / hit.inertia);
    EXPECT_NEAR(hit.ballSpeed(), SPEED - impulse / BALL, 1e-4) << multiplier;
    const double speed = hit.scene.world.jointState(0).velocity;
    EXPECT_NEAR(speed, -impulse * LEVER / hit.inertia, 1e-4) << multiplier;
    EXPECT_NEAR(hit.scene.world.jointState(1).velocity, multiplier * speed, 1e-9) << multiplier;
  }
}

// A stop that the blow leads away from does not hold.
TEST(HeldImpacts, AStopOnlyPushes) {
  HitLever hit(0.5, 0);
  BodyState state = hit.scene.world.bodyState(hit.ball);
  state.X_WB.translation().x() = 0.2;
  state.v_WCom = -state.v_WCom;
  hit.scene.world.setBodyState(hit.ball, state);
  hit.fly();
  const double impulse = (1 + E) * SPEED / (1 / BALL + LEVER * LEVER / hit.inertia);
  EXPECT_NEAR(hit.ballSpeed(), impulse / BALL - SPEED, 1e-4);
  EXPECT_NEAR(hit.scene.world.jointState(0).velocity, impulse * LEVER / hit.inertia, 1e-4);
}

}  // namespace
}  // namespace blem_sim::dynamics
