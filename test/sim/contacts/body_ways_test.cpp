// Ways of links through a solve against their closed forms.
#include "contacts/motion/body_ways.h"

#include <gtest/gtest.h>

#include <vector>

namespace blem_sim::sim {
namespace {

constexpr double LONG_STEP = 0.005;       // [s]
constexpr double UPPER = 0.4, COM = 0.3;  // [m] upper link, centre of mass of the lower one beyond the elbow

Matrix3 turned(double angle) { return Eigen::AngleAxisd(angle, Vector3::UnitY()).toRotationMatrix(); }

/** Two links along x in the plane y = 0. The upper one turns about the origin; the lower one turns, or slides, at the upper one's end. */
struct TwoLinks {
  SimulatedWorld world{Vector3::Zero(), dynamics::SolverSettings()};
  std::vector<dynamics::BodyState> bodies;
  int upper, lower;

  TwoLinks(dynamics::JointKind elbow, const Vector3& elbow_axis, double upper_speed, double lower_speed) {
    dynamics::BodySpec spec;
    spec.name = "upper";
    spec.inertial.mass = 1;
    spec.inertial.com = {0.5 * UPPER, 0, 0};
    spec.inertial.inertia = 0.01 * Matrix3::Identity();
    upper = world.world.addBody(spec);
    spec.name = "lower";
    spec.inertial.com = {COM, 0, 0};
    spec.X_WB = makePose({UPPER, 0, 0});
    lower = world.world.addBody(spec);
    dynamics::JointSpec joint;
    joint.name = "shoulder";
    joint.child = upper;
    joint.axis = Vector3::UnitY();
    const int shoulder = world.world.addJoint(joint);
    joint.name = "elbow";
    joint.kind = elbow;
    joint.parent = upper;
    joint.child = lower;
    joint.axis = elbow_axis;
    joint.X_PJ = makePose({UPPER, 0, 0});
    world.robots.emplace_back();
    world.robots[0].world_joints = {shoulder, world.world.addJoint(joint)};
    world.models.emplace_back();
    world.models[0].bodies = {upper, lower};
    world.bodyStates(&bodies);
    const Vector3 w1(0, upper_speed, 0), com = Vector3(UPPER + COM, 0, 0);
    const bool turns = elbow == dynamics::JointKind::REVOLUTE;
    const Vector3 w2 = turns ? Vector3(lower_speed * elbow_axis) : Vector3(Vector3::Zero());
    const Vector3 slide = turns ? Vector3(Vector3::Zero()) : Vector3(lower_speed * elbow_axis);
    bodies[upper].w_WB = w1;
    bodies[upper].v_WCom = w1.cross(Vector3(0.5 * UPPER, 0, 0));
    bodies[lower].w_WB = w1 + w2;
    bodies[lower].v_WCom = w1.cross(com) + w2.cross(Vector3(COM, 0, 0)) + slide;
  }

  /** Pose of a body's frame after a part of the solve. */
  Pose ahead(int body, double part) {
    BodyWays ways;
    ways.start(world, bodies, LONG_STEP);
    BodyTwist way = twistOf(world, bodies, body);
    ways.lead(body, &way);
    return way.moved(bodies[body].X_WB, part * LONG_STEP);
  }
};

void expectSame(const Pose& pose, const Matrix3& turn, const Vector3& place) {
  EXPECT_LT((pose.linear() - turn).norm(), 1e-12);
  EXPECT_LT((pose.translation() - place).norm(), 1e-12);
}

TEST(BodyWays, LinkOnAHingeOfTheWorldIsOnItsArcAllAlong) {
  for (const double speed : {1e-6, 0.1, 30.0, -300.0}) {
    TwoLinks arm(dynamics::JointKind::REVOLUTE, Vector3::UnitY(), speed, 0);
    for (const double part : {0.1, 0.5, 1.0}) {
      expectSame(arm.ahead(arm.upper, part), turned(part * LONG_STEP * speed), Vector3::Zero());
      expectSame(arm.ahead(arm.lower, part), turned(part * LONG_STEP * speed), turned(part * LONG_STEP * speed) * Vector3(UPPER, 0, 0));
    }
  }
}

TEST(BodyWays, LinkBeyondAnElbowEndsWhereItsJointsLead) {
  for (const double upper : {0.0, 5.0, -40.0})
    for (const double lower : {0.0, 5.0, 90.0}) {
      TwoLinks arm(dynamics::JointKind::REVOLUTE, Vector3::UnitY(), upper, lower);
      expectSame(arm.ahead(arm.lower, 1), turned(LONG_STEP * (upper + lower)), turned(LONG_STEP * upper) * Vector3(UPPER, 0, 0));
    }
}

TEST(BodyWays, LinkOnASliderThatTurnsEndsWhereItsJointsLead) {
  for (const double turn : {0.0, 1e-5, 20.0})
    for (const double slide : {0.0, 2.0}) {
      TwoLinks arm(dynamics::JointKind::PRISMATIC, Vector3::UnitX(), turn, slide);
      expectSame(arm.ahead(arm.lower, 1), turned(LONG_STEP * turn), turned(LONG_STEP * turn) * Vector3(UPPER + LONG_STEP * slide, 0, 0));
    }
}

TEST(BodyWays, LinksSwingEachOtherByNoMoreThanIsTold) {
  for (const double upper : {0.0, 5.0, -40.0})
    for (const double lower : {0.0, 5.0, 90.0}) {
      TwoLinks arm(dynamics::JointKind::REVOLUTE, Vector3::UnitY(), upper, lower);
      BodyWays ways;
      ways.start(arm.world, arm.bodies, LONG_STEP);
      const double w = upper + lower, centripetal = 0.5 * UPPER * upper * upper + COM * w * w;
      EXPECT_GE(ways.swing(arm.lower), LONG_STEP * centripetal * (1 - 1e-12));
      EXPECT_EQ(ways.swing(arm.upper), ways.swing(arm.lower));
      EXPECT_EQ(ways.swing(dynamics::WORLD_BODY), 0);
    }
}

/** The lower link is a rotor about its own axis, which lies along the upper link; its centre of mass is 0 or 1 mm off it. */
TEST(BodyWays, BalancedRotorsSwingNothing) {
  for (const double off : {0.0, 1e-3}) {
    TwoLinks arm(dynamics::JointKind::REVOLUTE, Vector3::UnitX(), 5, 0);
    geometry::MassProperties rotor = arm.world.world.bodySpec(arm.lower).inertial;
    rotor.com.y() = off;
    arm.world.world.setInertial(arm.lower, rotor);
    BodyWays ways;
    ways.start(arm.world, arm.bodies, LONG_STEP);
    const double still = ways.swing(arm.upper);
    arm.bodies[arm.lower].w_WB += 1000 * Vector3::UnitX();
    ways.start(arm.world, arm.bodies, LONG_STEP);
    if (off == 0) {
      EXPECT_NEAR(ways.swing(arm.upper), still, 1e-12 * still);
    } else {
      EXPECT_GT(ways.swing(arm.upper), 1000 * still);
    }
  }
}

TEST(BodyWays, LinkIsLedToAPose) {
  for (const double turn : {0.0, 1e-5, 0.3}) {
    TwoLinks arm(dynamics::JointKind::REVOLUTE, Vector3::UnitY(), 5, 90);
    BodyWays ways;
    ways.start(arm.world, arm.bodies, LONG_STEP);
    BodyTwist way = twistOf(arm.world, arm.bodies, arm.upper);
    ways.leadTo(arm.upper, makePose({0, 0, 0}, {0, turn, 0}), &way);
    for (const double part : {0.5, 1.0})
      expectSame(way.moved(arm.bodies[arm.upper].X_WB, part * LONG_STEP), turned(part * turn), Vector3::Zero());
  }
}

TEST(BodyWays, BodyOnNoJointGoesStraight) {
  TwoLinks arm(dynamics::JointKind::REVOLUTE, Vector3::UnitY(), 0, 0);
  dynamics::BodySpec spec;
  spec.name = "free";
  spec.inertial.mass = 1;
  spec.inertial.inertia = Matrix3::Identity();
  const int free = arm.world.world.addBody(spec);
  arm.bodies.emplace_back();
  arm.bodies[free].v_WCom = {1, 2, 3};
  arm.bodies[free].w_WB = {0, 10, 0};
  expectSame(arm.ahead(free, 0.5), turned(5 * LONG_STEP), 0.5 * LONG_STEP * Vector3(1, 2, 3));
  BodyWays ways;
  ways.start(arm.world, arm.bodies, LONG_STEP);
  EXPECT_EQ(ways.swing(free), 0);
}

}  // namespace
}  // namespace blem_sim::sim
