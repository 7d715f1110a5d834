// A gripper of one driven joint and three that mimic it lifts a cube and shakes it.
#include <gtest/gtest.h>

#include "dynamics/analytic_contacts.h"
#include "soak/figures.h"
#include "soak/world_figures.h"

namespace blem_sim {
namespace {

constexpr double DT = 1e-3;
constexpr double CUBE = 0.05, PROXIMAL = 0.08, HINGE = 0.06;  // [m] edge; finger's length; hinge off the palm's middle
constexpr double START_GAP = 1e-5;                            // [m] between pads and cube
constexpr double AMPLITUDE = 0.05;                            // [m] of the shaking at 1 Hz
const Vector3 TIP(0.02, 0.01, 0.03);                          // its inner face is the pad
const Vector3 SHAKEN = Vector3(1, 0.5, 2).normalized();

/** A sliding carriage, a wrist with its sensor, a palm, and two parallel fingers of two links each: q, q and -q, -q. */
struct Gripper {
  Gripper() : world(Vector3(0, 0, -9.81), soakSettings()) {
    closed = std::asin((HINGE - TIP.y() / 2 - CUBE / 2 - START_GAP) / PROXIMAL);
    carriage = world.addBody(dynamics::boxBody("carriage", 5, {0.1, 0.1, 0.1}, {0, 0, 0}));
    add(dynamics::JointKind::PRISMATIC, dynamics::WORLD_BODY, carriage, Pose::Identity(), SHAKEN, 0);
    palm = world.addBody(dynamics::boxBody("palm", 0.5, {0.05, 0.15, 0.04}, {0, 0, -0.1}));
    wrist = add(dynamics::JointKind::FIXED, carriage, palm, makePose({0, 0, -0.1}), Vector3::UnitZ(), 0);
    master = addFinger(1, -1);
    addFinger(-1, master);
    const Vector3 centre(0.003, 0, world.bodyState(tips[0]).X_WB.translation().z() - 0.015);
    cube = world.addBody(dynamics::boxBody("cube", 0.2, Vector3::Constant(CUBE), centre));
    load = {palm, cube};
    load.insert(load.end(), fingers.begin(), fingers.end());
    drives[0].stiffness = 1e6, drives[0].damping = 1e4;
    drives[master].stiffness = 200, drives[master].damping = 2, drives[master].max_effort = 2;
    drives[master].target_position = closed + 0.2;
  }

  int add(dynamics::JointKind kind, int parent, int child, const Pose& X_PJ, const Vector3& axis, double position, int mimicked = -1,
          double multiplier = 1) {
    dynamics::JointSpec spec;
    spec.name = "joint" + std::to_string(world.jointCount());
    spec.kind = kind;
    spec.parent = parent, spec.child = child;
    spec.X_PJ = X_PJ;
    spec.axis = axis;
    spec.mimic_joint = mimicked, spec.mimic_multiplier = multiplier;
    drives.push_back(dynamics::JointDrive());
    return world.addJoint(spec, position);
  }

  /** Adds a finger that closes with growing q. @param side 1: at +y @param first joint to be mimicked, -1 for none @return its hinge */
  int addFinger(int side, int first) {
    const Vector3 axis = -side * Vector3::UnitX();
    const auto turned = [&](double q) {
      Pose turn = Pose::Identity();
      turn.linear() = Eigen::AngleAxisd(q, axis).toRotationMatrix();
      return turn;
    };
    const Pose X_PH = makePose({0, side * HINGE, -0.03}), X_HT = makePose({0, 0, -PROXIMAL});
    dynamics::BodySpec proximal = dynamics::boxBody("proximal", 0.1, {0.02, 0.01, PROXIMAL}, Vector3::Zero());
    proximal.inertial.com = {0, 0, -PROXIMAL / 2};
    proximal.X_WB = world.bodyState(palm).X_WB * X_PH * turned(closed);
    dynamics::BodySpec tip = dynamics::boxBody("tip", 0.02, TIP, Vector3::Zero());
    tip.inertial.com = {0, 0, -TIP.z() / 2};
    tip.X_WB = proximal.X_WB * X_HT * turned(-closed);
    fingers.push_back(world.addBody(proximal));
    fingers.push_back(world.addBody(tip));
    tips.push_back(fingers.back());
    const int hinge = add(dynamics::JointKind::REVOLUTE, palm, fingers[fingers.size() - 2], X_PH, axis, closed, first);
    add(dynamics::JointKind::REVOLUTE, fingers[fingers.size() - 2], tips.back(), X_HT, axis, -closed, first < 0 ? hinge : first, -1);
    return hinge;
  }

  /** Four corners of each pad against the cube's face. */
  void findContacts() {
    contacts.clear();
    const Pose X_WC = world.bodyState(cube).X_WB;
    for (int finger = 0; finger < 2; ++finger) {
      const double side = finger == 0 ? 1 : -1;
      const Pose X_WT = world.bodyState(tips[finger]).X_WB;
      for (int i = 0; i < 4; ++i) {
        const Vector3 p_T(i & 1 ? TIP.x() / 2 : -TIP.x() / 2, -side * TIP.y() / 2, i & 2 ? -TIP.z() : 0);
        const double gap = side * (X_WC.inverse() * (X_WT * p_T)).y() - CUBE / 2;
        if (gap >= dynamics::CONTACT_MARGIN) continue;
        contacts.push_back(
            dynamics::contactOf(cube, tips[finger], X_WT * p_T, -side * X_WC.linear().col(1), -gap, {0.8}, 1 + 4 * finger + i));
      }
    }
  }

  const dynamics::SolveResult& step() {
    findContacts();
    const double t = DT * ++steps, phase = 2 * M_PI * t;
    drives[0].target_position = AMPLITUDE * (1 - std::cos(phase));
    drives[0].target_velocity = AMPLITUDE * 2 * M_PI * std::sin(phase);
    times.start();
    const dynamics::SolveResult& result = world.step(DT, contacts, drives);
    times.stop(result);
    return result;
  }
  Pose cubeInPalm() const { return world.bodyState(palm).X_WB.inverse() * world.bodyState(cube).X_WB; }

  dynamics::World world;
  std::vector<dynamics::JointDrive> drives;
  std::vector<dynamics::ContactConstraint> contacts;
  int carriage, palm, wrist, master, cube;
  double closed;
  long steps = 0;
  std::vector<int> fingers, tips, load;
  StepTimes times;
};

/** [m] furthest that a corner of the cube moved. */
double cornerMotion(const Pose& before, const Pose& after) {
  double worst = 0;
  for (int i = 0; i < 8; ++i) {
    const Vector3 p = dynamics::corner(Vector3::Constant(CUBE), i);
    worst = std::max(worst, (after * p - before * p).norm());
  }
  return worst;
}

/** Largest deviations, and the largest torque, against which they are measured. */
struct WrenchErrors {
  double force = 0, torque = 0, largest_torque = 0;
  void add(const Wrench& measured, const Wrench& expected) {
    force = std::max(force, (measured.force - expected.force).norm() / expected.force.norm());
    torque = std::max(torque, (measured.torque - expected.torque).norm());
    largest_torque = std::max(largest_torque, expected.torque.norm());
  }
};

TEST(SoakGripper, HoldsAShakenCube) {
  Gripper gripper;
  const int steps = soakSteps(60, 5);
  Pose settled = Pose::Identity();
  double slip = 0, mimic = 0, load_error = 0;
  WrenchErrors wrist;
  for (int i = 0; i < steps; ++i) {
    if (i == 1000) settled = gripper.cubeInPalm();
    const std::vector<dynamics::BodyState> before = bodyStates(gripper.world);
    const Vector3 about = jointFrame(gripper.world, gripper.wrist).translation();
    const dynamics::SolveResult& result = gripper.step();
    ASSERT_TRUE(result.finite) << i;
    const double q = gripper.world.jointState(gripper.master).position;
    for (int j = gripper.master; j < gripper.world.jointCount(); ++j) {
      const double multiplier = j == gripper.master ? 1 : gripper.world.jointSpec(j).mimic_multiplier;
      mimic = std::max(mimic, std::abs(gripper.world.jointState(j).position - multiplier * q));
    }
    if (i < 1000) continue;
    slip = std::max(slip, cornerMotion(settled, gripper.cubeInPalm()));
    wrist.add(result.joint_wrenches[gripper.wrist], neededWrench(gripper.world, before, gripper.load, DT, about));
    Vector3 on_cube = Vector3::Zero();
    for (const Vector3& f : result.contact_forces) on_cube += f;
    const Vector3 needed = neededWrench(gripper.world, before, {gripper.cube}, DT, about).force;
    load_error = std::max(load_error, (on_cube - needed).norm() / needed.norm());
  }
  figure("gripper: slip", slip, "m");
  figure("gripper: mimic joints off", mimic, "rad");
  figure("gripper: wrist force off, relative", wrist.force, "");
  figure("gripper: wrist torque off, of the largest", wrist.torque / wrist.largest_torque, "");
  figure("gripper: force on the cube off, relative", load_error, "");
  gripper.times.print("gripper");
  EXPECT_LT(slip, 1e-5);
  EXPECT_LE(wrist.force, 1e-3);
  EXPECT_LE(wrist.torque, 1e-3 * wrist.largest_torque);
  EXPECT_LE(load_error, 1e-3);
}

}  // namespace
}  // namespace blem_sim
