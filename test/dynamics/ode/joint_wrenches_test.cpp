// Wrenches from motion against statics, analytic dynamics and ODE's own feedback.
#include "ode/joint_wrenches.h"

#include <gtest/gtest.h>

#include "dynamics/analytic_contacts.h"
#include "scene/joint_readings.h"
#include "stepper_table.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

BodySpec wrenchBar(double mass, double length) {
  BodySpec spec = boxBody("bar", mass, {length, 0.02, 0.02}, Vector3::Zero());
  spec.inertial.com = {length / 2, 0, 0};
  return spec;
}

int join(World* world, JointKind kind, int parent, int child, const Pose& X_PJ, const Vector3& axis) {
  JointSpec spec;
  spec.name = "joint" + std::to_string(child);
  spec.kind = kind;
  spec.parent = parent, spec.child = child, spec.X_PJ = X_PJ, spec.axis = axis;
  return world->addJoint(spec);
}

TEST(JointWrenches, CantileverCarriesWeightAndMoment) {
  World world(GRAVITY, {});
  BodySpec inner = wrenchBar(2, 0.5), outer = wrenchBar(1, 0.4);
  outer.X_WB = makePose({0.5, 0, 0});
  world.addBody(inner), world.addBody(outer);
  join(&world, JointKind::FIXED, WORLD_BODY, 0, Pose::Identity(), Vector3::UnitZ());
  join(&world, JointKind::FIXED, 0, 1, makePose({0.5, 0, 0}), Vector3::UnitZ());
  SolveResult result;
  for (int i = 0; i < 2000; ++i) result = world.step(DT, {}, std::vector<JointDrive>(2));
  EXPECT_NEAR((result.joint_wrenches[0].force - Vector3(0, 0, 3 * G)).norm(), 0, 1e-9);
  EXPECT_NEAR((result.joint_wrenches[1].force - Vector3(0, 0, G)).norm(), 0, 1e-9);
  EXPECT_NEAR((result.joint_wrenches[0].torque - Vector3(0, -(2 * 0.25 + 1 * 0.7) * G, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((result.joint_wrenches[1].torque - Vector3(0, -0.2 * G, 0)).norm(), 0, 1e-6);
}

TEST(JointWrenches, HangingChainCarriesWhatHangsBelow) {
  World world(GRAVITY, {});
  int parent = WORLD_BODY;
  for (int i = 0; i < 5; ++i) {
    BodySpec link = boxBody("link", 0.5 + i, {0.02, 0.02, 0.2}, {0, 0, -0.2 * i});
    link.inertial.com = {0, 0, -0.1};
    const int body = world.addBody(link);
    join(&world, JointKind::REVOLUTE, parent, body, parent == WORLD_BODY ? Pose::Identity() : makePose({0, 0, -0.2}), Vector3::UnitX());
    parent = body;
  }
  SolveResult result;
  for (int i = 0; i < 500; ++i) result = world.step(DT, {}, std::vector<JointDrive>(5));
  double below = 0;
  for (int j = 4; j >= 0; --j) {
    below += 0.5 + j;
    EXPECT_NEAR((result.joint_wrenches[j].force - Vector3(0, 0, below * G)).norm(), 0, 1e-9);
    EXPECT_NEAR(result.joint_wrenches[j].torque.norm(), 0, 1e-9);
  }
}

// At the angle q from the horizontal a uniform bar's pivot carries m (g + a_com), with alpha = 3 g cos q / 2 l.
TEST(JointWrenches, SwingingBarMatchesTheory) {
  const double mass = 1.5, length = 0.8;
  World world(GRAVITY, {});
  BodySpec spec = wrenchBar(mass, length);
  spec.inertial.inertia = Vector3(1e-4, mass * length * length / 12, mass * length * length / 12).asDiagonal();
  world.addBody(spec);
  join(&world, JointKind::REVOLUTE, WORLD_BODY, 0, Pose::Identity(), Vector3::UnitY());
  for (int i = 0; i < 400; ++i) {
    const double q = world.jointState(0).position, v = world.jointState(0).velocity;
    const Wrench w = world.step(DT, {}, {JointDrive()}).joint_wrenches[0];
    const double alpha = 1.5 * G * std::cos(q) / length;
    const Vector3 along(std::cos(q), 0, -std::sin(q)), across(-std::sin(q), 0, -std::cos(q));
    const Vector3 theory = mass * (0.5 * length * (alpha * across - v * v * along) + Vector3(0, 0, G));
    ASSERT_NEAR((w.force - theory).norm(), 0, 0.01 * mass * G) << i;
    ASSERT_NEAR(w.torque.norm(), 0, 0.02);
  }
}

// Distance between a hinge's anchors on its two bodies: ODE's joints drift a little while they move.
double hingeGap(const JointSlot& slot) {
  if (slot.spec.kind != JointKind::REVOLUTE) return 0;
  dVector3 on_child, on_parent;
  dJointGetHingeAnchor(slot.joint, on_child);
  dJointGetHingeAnchor2(slot.joint, on_parent);
  return (fromOde(on_child) - fromOde(on_parent)).norm();
}

// Three moving links with motors, a limit, an outside wrench and a contact: the same as ODE's own reactions, but for the moment that the
// forces of outer joints have over their gaps.
TEST(JointWrenches, AgreeWithOdesFeedback) {
  Scene scene(GRAVITY, {});
  int parent = WORLD_BODY;
  for (int i = 0; i < 3; ++i) {
    BodySpec link = wrenchBar(1 + i, 0.5);
    link.X_WB = makePose({0.5 * i, 0, 0});
    const int body = scene.addBody(link);
    JointSpec spec;
    spec.kind = i == 1 ? JointKind::PRISMATIC : JointKind::REVOLUTE;
    spec.parent = parent, spec.child = body;
    spec.X_PJ = parent == WORLD_BODY ? Pose::Identity() : makePose({0.5, 0, 0});
    spec.axis = i == 1 ? Vector3::UnitX() : Vector3(0.1, 1, 0.3 * i);
    spec.upper = 0.4;
    scene.addJoint(spec, 0);
    parent = body;
  }
  SolverSettings settings;
  settings.stepper = "world_step";
  const auto stepper = makeStepper(settings);
  std::vector<JointDrive> drives(3);
  drives[0].effort = -3, drives[0].dry_friction = 0.5;
  drives[1].stiffness = 500, drives[1].damping = 20, drives[1].max_effort = 30;
  drives[2].viscous_friction = 0.3, drives[2].effort = 1;
  std::vector<BodyBits> start;
  for (int i = 0; i < 500; ++i) {
    scene.bits(&start);
    scene.bodies()[1].pending = {{1, 2, 3}, {0.1, 0.2, 0.3}};
    const Vector3 tip = scene.bodyState(2).X_WB * Vector3(0.5, 0, 0);
    const std::vector<ContactConstraint> contacts = {contactOf(2, WORLD_BODY, tip, Vector3::UnitZ(), -1.0 - tip.z(), {}, 1)};
    std::vector<Vector3> axes;
    std::vector<double> gaps;
    for (int j = 0; j < 3; ++j) axes.push_back(jointAxis(scene, j)), gaps.push_back(hingeGap(scene.joints()[j]));
    const StepInput input{DT, contacts, drives};
    SolveResult result;
    stepper->step(&scene, input, &result);
    const std::vector<Wrench>& wrenches = result.joint_wrenches;
    double gap_moment = 0;
    for (int j = 2; j >= 0; --j) {
      const JointSlot& slot = scene.joints()[j];
      Vector3 force = fromOde(slot.joint_feedback.f1) + fromOde(slot.motor_feedback.f1);
      Vector3 torque = fromOde(slot.joint_feedback.t1) + fromOde(slot.motor_feedback.t1);
      const Vector3 com = start[slot.spec.child].com();
      (j == 1 ? force : torque) += drives[j].effort * axes[j];
      torque += (com - jointOrigin(scene, j, start)).cross(force);
      ASSERT_NEAR((wrenches[j].force - force).norm(), 0, 1e-8 * (1 + force.norm())) << i << " " << j;
      ASSERT_NEAR((wrenches[j].torque - torque).norm(), 0, 1e-8 * (1 + torque.norm()) + 1.01 * gap_moment) << i << " " << j;
      gap_moment += gaps[j] * force.norm();
    }
  }
}

// A table on two legs joined to one top closes a loop through the world.
// The load that motion does not determine comes from ODE's feedback.
TEST(JointWrenches, LoopIsSharedByItsJoints) {
  SolverSettings settings;
  settings.stepper = "world_step";
  World world(GRAVITY, settings);
  const int top = world.addBody(boxBody("top", 3, {1, 0.1, 0.1}, Vector3::Zero()));
  const int left = join(&world, JointKind::FIXED, WORLD_BODY, top, makePose({-0.5, 0, 0}), Vector3::UnitZ());
  const int right = join(&world, JointKind::FIXED, WORLD_BODY, top, makePose({0.5, 0, 0}), Vector3::UnitZ());
  SolveResult result;
  for (int i = 0; i < 200; ++i) result = world.step(DT, {}, std::vector<JointDrive>(2));
  EXPECT_NEAR(result.joint_wrenches[left].force.z() + result.joint_wrenches[right].force.z(), 3 * G, 1e-8);
  EXPECT_GT(result.joint_wrenches[right].force.z(), 1);
}

// A robot's foot on the ground: the sensor above it carries the weight above it.
TEST(JointWrenches, StandingOnAContact) {
  World world(GRAVITY, {});
  const Vector3 foot_size(0.2, 0.1, 0.05);
  const int foot = world.addBody(boxBody("foot", 1, foot_size, {0, 0, 0.025}));
  const int leg = world.addBody(boxBody("leg", 4, {0.05, 0.05, 0.5}, {0.02, 0, 0.3}));
  const int ankle = join(&world, JointKind::REVOLUTE, foot, leg, makePose({0, 0, 0.025}), Vector3::UnitY());
  JointDrive drive;
  drive.stiffness = 1e4, drive.damping = 100;
  SolveResult result;
  for (int i = 0; i < 3000; ++i) {
    std::vector<ContactConstraint> contacts;
    boxOnPlane(world, foot, foot_size, Vector3::UnitZ(), 0, {}, &contacts);
    result = world.step(DT, contacts, {drive});
  }
  EXPECT_NEAR((result.joint_wrenches[ankle].force - Vector3(0, 0, 4 * G)).norm(), 0, 1e-7);
  EXPECT_NEAR(result.joint_wrenches[ankle].torque.y(), result.axis_efforts[ankle], 1e-7);
  EXPECT_NEAR(result.axis_efforts[ankle], -4 * G * 0.02, 1e-3);
}

}  // namespace
}  // namespace blem_sim::dynamics
