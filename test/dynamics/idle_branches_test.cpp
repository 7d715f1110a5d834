// Branches that nothing touches are not iterated while their joints answer linearly: the solution must not show it.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

constexpr double FRICTION = 0.5;
constexpr int ARMS = 2, LINKS = 6;
const Vector3 BASE(0.6, 0.6, 0.2);

/** A heavy box on a plane that holds two chains by joints with dry friction, without motors. */
struct Hanger {
  Hanger() : world(Vector3(0, 0, -9.81), {}) {
    const int base = world.addBody(boxBody("base", 20, BASE, {0, 0, 0.1}));
    for (int arm = 0; arm < ARMS; ++arm) {
      int parent = base;
      for (int i = 0; i < LINKS; ++i) {
        const Vector3 joint(0, arm - 0.5, 0.8 - 0.1 * i);
        const int body = world.addBody(boxBody("link", 0.3, {0.04, 0.04, 0.1}, joint - Vector3(0, 0, 0.05)));
        JointSpec spec;
        spec.name = "joint";
        spec.parent = parent;
        spec.child = parent = body;
        spec.X_PJ = makePose(joint - world.bodySpec(spec.parent).X_WB.translation());
        spec.axis = Vector3::UnitY();
        world.addJoint(spec);
      }
    }
    drives.resize(ARMS * LINKS);
    for (JointDrive& drive : drives) drive.dry_friction = FRICTION;
  }

  /** Makes a step and counts the joints that began or ceased to slip. */
  void step() {
    std::vector<ContactConstraint> contacts;
    boxOnPlane(world, 0, BASE, Vector3::UnitZ(), 0, {}, &contacts);
    ASSERT_FALSE(contacts.empty());
    std::vector<Vector3> axes;
    for (int j = 0; j < world.jointCount(); ++j)
      axes.push_back(world.bodyState(world.jointSpec(j).parent).X_WB.linear() * world.jointSpec(j).axis);
    const SolveResult& result = world.step(DT, contacts, drives);
    ASSERT_TRUE(result.finite);
    EXPECT_LT(result.creep, 1e-7);
    EXPECT_LT(result.residual, 1e-4);
    slips.resize(drives.size(), false);
    for (int j = 0; j < world.jointCount(); ++j) {
      const double v = world.jointState(j).velocity, friction = result.axis_efforts[j] - drives[j].effort;
      // The wrench follows from the bodies' motion, the effort from the joint's law.
      EXPECT_NEAR(result.joint_wrenches[j].torque.dot(axes[j]), result.axis_efforts[j] + result.free_efforts[j], 1e-6) << j;
      EXPECT_LE(std::abs(friction), FRICTION * (1 + 1e-12)) << j;
      const bool slip = std::abs(v) > 1e-6;
      if (slip) {
        EXPECT_NEAR(friction, v > 0 ? -FRICTION : FRICTION, 1e-9) << j;
      }
      changes += slip != slips[j];
      slips[j] = slip;
    }
  }

  World world;
  std::vector<JointDrive> drives;
  std::vector<char> slips;
  int changes = 0;
};

TEST(IdleBranches, OneJointBeginsToSlipAndStops) {
  Hanger hanger;
  for (int i = 0; i < 300 && !::testing::Test::HasFailure(); ++i) {
    hanger.drives[LINKS - 1].effort = 1.2 * FRICTION * std::sin(0.1 * i);
    hanger.step();
  }
  EXPECT_GT(hanger.changes, 10);
}

TEST(IdleBranches, AllJointsBeginToSlipAtOnce) {
  Hanger hanger;
  for (int i = 0; i < 300 && !::testing::Test::HasFailure(); ++i) {
    for (JointDrive& drive : hanger.drives) drive.effort = i % 40 < 3 ? 4 * FRICTION : 0;
    hanger.step();
  }
  EXPECT_GT(hanger.changes, 50);
}

// The last change of friction that sticks is part of the state: the next step expects it to go on.
TEST(IdleBranches, DriftOfStuckFrictionIsRestored) {
  Hanger hanger;
  const auto drift = [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      hanger.drives[LINKS - 1].effort = 0.8 * FRICTION * std::sin(0.02 * i);
      hanger.step();
    }
    return hanger.world.jointState(LINKS - 1).velocity;
  };
  drift(0, 50);
  const WorldState state = hanger.world.save();
  const double velocity = drift(50, 51);
  drift(51, 80);
  hanger.world.restore(state);
  EXPECT_EQ(drift(50, 51), velocity);
}

}  // namespace
}  // namespace blem_sim::dynamics
