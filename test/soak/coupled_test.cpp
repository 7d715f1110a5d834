// Mechanisms that are no plain tree: two robots pushing each other, and a four-bar linkage.
#include <gtest/gtest.h>

#include "dynamics/analytic_contacts.h"
#include "soak/figures.h"
#include "soak/world_figures.h"

namespace blem_sim {
namespace {

constexpr double DT = 1e-3;
const Vector3 GRAVITY(0, 0, -9.81);
const Vector3 HAND(0.1, 0.08, 0.08);

/** A world of links that are each their own joint's child, with the drives beside them. */
struct Mechanism {
  Mechanism() : world(GRAVITY, soakSettings()) {}
  /** Adds a link whose frame is the joint's; its box lies from there to `reach`. */
  int addLink(const std::string& name, double mass, const Vector3& reach, const Pose& X_WB) {
    dynamics::BodySpec spec = dynamics::boxBody(name, mass, reach.cwiseAbs() + Vector3::Constant(0.02), Vector3::Zero());
    spec.inertial.com = reach / 2;
    spec.X_WB = X_WB;
    return world.addBody(spec);
  }
  int addJoint(dynamics::JointKind kind, int parent, int child, const Vector3& axis) {
    dynamics::JointSpec spec;
    spec.name = "joint" + std::to_string(world.jointCount());
    spec.kind = kind;
    spec.parent = parent, spec.child = child;
    spec.X_PJ = (parent == dynamics::WORLD_BODY ? Pose::Identity() : world.bodySpec(parent).X_WB).inverse() * world.bodySpec(child).X_WB;
    spec.axis = axis;
    drives.push_back(dynamics::JointDrive());
    return world.addJoint(spec);
  }
  dynamics::World world;
  std::vector<dynamics::JointDrive> drives;
};

/** Two arms on fixed bases that face each other along x: a slide, a hinged wrist, a hand whose face pushes. */
struct Pushers : Mechanism {
  Pushers() {
    for (const double side : {-1.0, 1.0}) {
      const int base = addLink("base", 5, {0, 0, 0.1}, makePose({side * 1.0, 0, 0}));
      const int slide = addLink("slide", 2, {-0.5 * side, 0, 0}, makePose({side * 0.7, 0, 0}));
      const int hand = addLink("hand", 1, {-HAND.x() * side, 0, 0}, makePose({side * (HAND.x() + 0.001), 0, 0}));
      bases.push_back(addJoint(dynamics::JointKind::FIXED, dynamics::WORLD_BODY, base, Vector3::UnitX()));
      const int push = addJoint(dynamics::JointKind::PRISMATIC, base, slide, Vector3::UnitX());
      const int wrist = addJoint(dynamics::JointKind::REVOLUTE, slide, hand, Vector3::UnitY());
      // Unequal stiffnesses: one gives way until the other's spring balances it.
      drives[push].stiffness = side < 0 ? 4000 : 1500, drives[push].damping = 200, drives[push].target_position = -0.05 * side;
      drives[push].dry_friction = 2;
      drives[wrist].stiffness = 50, drives[wrist].damping = 1;
      hands.push_back(hand);
      arms.push_back({base, slide, hand});
    }
  }
  const dynamics::SolveResult& step() {
    contacts.clear();
    const Pose X_WA = world.bodyState(hands[0]).X_WB, X_WB = world.bodyState(hands[1]).X_WB;
    for (int i = 0; i < 4; ++i) {
      const Vector3 p = X_WA * Vector3(HAND.x(), (i & 1 ? 0.5 : -0.5) * HAND.y(), (i & 2 ? 0.5 : -0.5) * HAND.z());
      const double gap = -HAND.x() - (X_WB.inverse() * p).x();
      if (gap < 5 * dynamics::CONTACT_MARGIN)
        contacts.push_back(dynamics::contactOf(hands[0], hands[1], p, -X_WB.linear().col(0), -gap, {}, i + 1));
    }
    return world.step(DT, contacts, drives);
  }
  std::vector<int> hands, bases;
  std::vector<std::vector<int>> arms;
  std::vector<dynamics::ContactConstraint> contacts;
};

TEST(SoakPushing, ForcesAreEqualAndOpposite) {
  Pushers pushers;
  // In motion the two ways to reckon a step's forces, from joint coordinates and from bodies, differ by the forces' change.
  double moving = 0, worst = 0, force = 0, gap = 0;
  const int steps = soakSteps(20, 3);
  for (int i = 0; i < steps; ++i) {
    const std::vector<dynamics::BodyState> before = bodyStates(pushers.world);
    const dynamics::SolveResult& result = pushers.step();
    ASSERT_TRUE(result.finite) << i;
    // Force on each robot from the other: that which its bodies' motion needs, less its base's.
    Vector3 felt[2];
    for (int k = 0; k < 2; ++k)
      felt[k] =
          neededWrench(pushers.world, before, pushers.arms[k], DT, Vector3::Zero()).force - result.joint_wrenches[pushers.bases[k]].force;
    double& off = i < steps / 2 ? moving : worst;
    off = std::max(off, (felt[0] + felt[1]).norm());
    force = felt[1].x();
    gap = std::max(gap, worstJointGap(pushers.world));
  }
  figure("pushing: force at the end", force, "N");
  figure("pushing: forces equal and opposite", worst, "N");
  figure("pushing: joint gap", gap, "m");
  figure("pushing: the same while they still move", moving, "N");
  EXPECT_GT(force, 10);
  EXPECT_LE(worst, 1e-9);
  EXPECT_LE(moving, 1e-4 * force);
}

/** Crank, coupler, rocker; the coupler's far end is a pin of its own, whose second joint closes the loop. */
struct FourBar : Mechanism {
  FourBar() {
    const Vector3 crank_end(0, 0, 0.1), rocker_foot(0.3, 0, 0), rocker_end(0.35, 0, 0.25);
    const int crank = addLink("crank", 0.3, crank_end, Pose::Identity());
    const int coupler = addLink("coupler", 0.6, rocker_end - crank_end, makePose(crank_end));
    const int rocker = addLink("rocker", 0.5, rocker_end - rocker_foot, makePose(rocker_foot));
    const int pin = addLink("pin", 0.05, Vector3::Zero(), makePose(rocker_end));
    addJoint(dynamics::JointKind::REVOLUTE, dynamics::WORLD_BODY, crank, Vector3::UnitY());
    addJoint(dynamics::JointKind::REVOLUTE, crank, coupler, Vector3::UnitY());
    addJoint(dynamics::JointKind::REVOLUTE, dynamics::WORLD_BODY, rocker, Vector3::UnitY());
    addJoint(dynamics::JointKind::FIXED, coupler, pin, Vector3::UnitY());
    closing = addJoint(dynamics::JointKind::REVOLUTE, rocker, pin, Vector3::UnitY());
  }
  int closing;
};

TEST(SoakFourBar, StaysClosedWhileItsCrankTurns) {
  FourBar bar;
  bar.drives[0].damping = 100;
  bar.drives[0].target_velocity = 3;
  double gap = 0, tilt = 0;
  StepTimes times;
  for (int i = 0; i < soakSteps(20, 3); ++i) {
    times.start();
    const dynamics::SolveResult& result = bar.world.step(DT, {}, bar.drives);
    times.stop(result);
    ASSERT_TRUE(result.finite) << i;
    gap = std::max(gap, jointGap(bar.world, bar.closing));
    tilt = std::max(tilt, jointTilt(bar.world, bar.closing));
  }
  figure("four-bar: loop closed within", gap, "m");
  figure("four-bar: axes of its closing joint", tilt, "rad");
  figure("four-bar: crank speed", bar.world.jointState(0).velocity, "rad/s");
  times.print("four-bar");
  EXPECT_LE(gap, 1e-6);
  EXPECT_NEAR(bar.world.jointState(0).velocity, 3, 0.3);
}

// A four-bar without any motor swings, and neither opens nor gains energy.
TEST(SoakFourBar, SwingsFreely) {
  FourBar bar;
  const double start = bar.world.kineticEnergy() + bar.world.potentialEnergy();
  double gap = 0, energy = -INFINITY;
  for (int i = 0; i < soakSteps(20, 3); ++i) {
    ASSERT_TRUE(bar.world.step(DT, {}, bar.drives).finite) << i;
    gap = std::max(gap, jointGap(bar.world, bar.closing));
    energy = std::max(energy, bar.world.kineticEnergy() + bar.world.potentialEnergy() - start);
  }
  figure("four-bar swinging: loop closed within", gap, "m");
  figure("four-bar swinging: energy above its start", energy, "J");
  EXPECT_LE(gap, 1e-6);
}

}  // namespace
}  // namespace blem_sim
