// Mimic joints: kinematics under load, reaction on the master, a grasp.
#include <gtest/gtest.h>

#include <algorithm>

#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

JointSpec coupledJoint(JointKind kind, int parent, int child, const Pose& X_PJ, const Vector3& axis) {
  JointSpec spec;
  spec.name = "joint" + std::to_string(child);
  spec.kind = kind;
  spec.parent = parent, spec.child = child, spec.X_PJ = X_PJ, spec.axis = axis;
  return spec;
}

BodySpec coupledBar(double length, double mass) {
  BodySpec spec = boxBody("bar", mass, {length, 0.02, 0.02}, Vector3::Zero());
  spec.inertial.com = {length / 2, 0, 0};
  return spec;
}

// A gripper's relation, a chain's, and one with an offset: all hold to rounding while the master is driven and the fingers are loaded.
TEST(Mimic, FollowsItsMasterUnderLoad) {
  World world({0, 0, -G}, {});
  const int palm = world.addBody(boxBody("palm", 1, {0.1, 0.1, 0.1}, Vector3::Zero()));
  BodySpec finger = coupledBar(0.1, 0.1);
  const int left = world.addBody(finger);
  finger.X_WB = makePose({0.1, 0, 0});
  const int tip = world.addBody(finger);
  finger.X_WB = makePose({0, 0.05, 0});
  const int right = world.addBody(finger);
  world.addJoint(coupledJoint(JointKind::FIXED, WORLD_BODY, palm, Pose::Identity(), Vector3::UnitZ()));
  const int master = world.addJoint(coupledJoint(JointKind::REVOLUTE, palm, left, Pose::Identity(), Vector3::UnitY()));
  JointSpec chain = coupledJoint(JointKind::REVOLUTE, left, tip, makePose({0.1, 0, 0}), Vector3::UnitY());
  chain.mimic_joint = master, chain.mimic_multiplier = 0.7;
  JointSpec mirror = coupledJoint(JointKind::REVOLUTE, palm, right, makePose({0, 0.05, 0}), Vector3::UnitY());
  mirror.mimic_joint = master, mirror.mimic_multiplier = -1.5, mirror.mimic_offset = 0.1;
  const int tip_joint = world.addJoint(chain), right_joint = world.addJoint(mirror, 0.1);
  std::vector<JointDrive> drives(4);
  drives[1].stiffness = 50, drives[1].damping = 1, drives[1].target_position = 0.6;
  double worst = 0;
  for (int i = 0; i < 1500; ++i) {
    drives[1].target_position = 0.6 * std::sin(5 * i * DT);
    world.applyWrench(right, {{0, 0, 3 * std::sin(20 * i * DT)}, Vector3::Zero()}, world.bodyState(right).X_WB * Vector3(0.1, 0, 0));
    world.step(DT, {}, drives);
    const double q = world.jointState(master).position;
    worst = std::max(worst, std::abs(world.jointState(tip_joint).position - 0.7 * q));
    worst = std::max(worst, std::abs(world.jointState(right_joint).position + 1.5 * q - 0.1));
  }
  EXPECT_LT(worst, 1e-10);
}

// The master alone carries the mimic joint's load: virtual work.
TEST(Mimic, HandsItsLoadToTheMaster) {
  World world({0, 0, -G}, {});
  const int a = world.addBody(coupledBar(1, 1)), b = world.addBody(coupledBar(1, 1));
  const int master = world.addJoint(coupledJoint(JointKind::REVOLUTE, WORLD_BODY, a, Pose::Identity(), Vector3::UnitY()));
  JointSpec spec = coupledJoint(JointKind::REVOLUTE, WORLD_BODY, b, Pose::Identity(), Vector3::UnitY());
  spec.mimic_joint = master, spec.mimic_multiplier = 2;
  const int mimic = world.addJoint(spec);
  std::vector<JointDrive> drives(2);
  drives[0].stiffness = 1e5, drives[0].damping = 1e3;
  for (int i = 0; i < 3000; ++i) world.step(DT, {}, drives);
  const SolveResult& result = world.step(DT, {}, drives);
  // Moment of weight about +y of a bar along +x is +m g l/2; the master carries its own and twice the other's.
  const double q = world.jointState(master).position;
  EXPECT_NEAR(1e5 * q, (std::cos(q) + 2 * std::cos(2 * q)) * 9.81 * 0.5, 1e-3);
  EXPECT_NEAR(world.jointState(master).effort, -1e5 * q, 1e-3);
  EXPECT_EQ(world.jointState(mimic).effort, 0) << "it has no motor";
  EXPECT_NEAR(result.axis_efforts[mimic], -9.81 * 0.5, 1e-3);
}

/** Two fingers that slide towards each other, the second mimicking the first, and a cube between them. */
struct Gripper {
  Gripper() : world({0, 0, -G}, {}) {
    palm = world.addBody(boxBody("palm", 1, {0.2, 0.1, 0.05}, {0, 0, 0.2}));
    left = world.addBody(boxBody("left", 0.1, PAD, {-0.031, 0, 0}));
    right = world.addBody(boxBody("right", 0.1, PAD, {0.031, 0, 0}));
    cube = world.addBody(boxBody("cube", 0.2, CUBE, Vector3::Zero()));
    world.addJoint(coupledJoint(JointKind::PRISMATIC, WORLD_BODY, palm, makePose({0, 0, 0.2}), Vector3::UnitX()));
    world.addJoint(coupledJoint(JointKind::PRISMATIC, palm, left, makePose({-0.031, 0, -0.2}), Vector3::UnitX()));
    JointSpec mimic = coupledJoint(JointKind::PRISMATIC, palm, right, makePose({0.031, 0, -0.2}), -Vector3::UnitX());
    mimic.mimic_joint = 1;
    world.addJoint(mimic);
    drives.resize(3);
    drives[0].stiffness = 1e5, drives[0].damping = 2e3;
    drives[1].stiffness = 1e4, drives[1].damping = 200, drives[1].target_position = 0.01, drives[1].max_effort = 20;
  }
  void pad(int finger, double side) {
    const Pose X_WC = world.bodyState(cube).X_WB, X_WF = world.bodyState(finger).X_WB;
    const Vector3 normal = X_WC.linear().col(0) * -side;  // from the finger into the cube
    for (int i = 0; i < 4; ++i) {
      const Vector3 p = X_WC * Vector3(side * 0.02, i & 1 ? 0.01 : -0.01, i & 2 ? 0.01 : -0.01);
      const double gap = side * (X_WF.translation().x() - p.x()) - 0.01;
      contacts.push_back(contactOf(cube, finger, p, normal, -gap, {}, 10 * finger + i));
    }
  }
  const SolveResult& step() {
    contacts.clear();
    pad(left, -1), pad(right, 1);
    return world.step(DT, contacts, drives);
  }

  const Vector3 PAD{0.02, 0.02, 0.02}, CUBE{0.04, 0.04, 0.04};
  World world;
  int palm, left, right, cube;
  std::vector<ContactConstraint> contacts;
  std::vector<JointDrive> drives;
};

// The master's 20 N close both fingers, so each presses with 10 N; gravity acts across, friction holds.
TEST(Mimic, GripperHoldsACubeWhileShaken) {
  Gripper gripper;
  gripper.drives[1].target_position = 0.1;
  SolveResult result;
  double worst = 0, slip = 0;
  for (int i = 0; i < 3000; ++i) {
    gripper.drives[0].target_position = 0.02 * std::sin(2 * M_PI * i * DT);
    result = gripper.step();
    ASSERT_TRUE(result.finite);
    worst = std::max(worst, std::abs(gripper.world.jointState(2).position - gripper.world.jointState(1).position));
    slip = std::max(slip, std::abs(gripper.world.bodyState(gripper.cube).X_WB.translation().z()));
  }
  EXPECT_LT(worst, 1e-10);
  EXPECT_LT(slip, 1e-4);
  double left = 0, right = 0;
  for (std::size_t k = 0; k < 8; ++k) (gripper.contacts[k].body_b == gripper.left ? left : right) += result.contact_forces[k].x();
  EXPECT_NEAR((left - right) / 2, 10, 0.01);
}

}  // namespace
}  // namespace blem_sim::dynamics
