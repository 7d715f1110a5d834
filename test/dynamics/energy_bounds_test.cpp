// Contacts and loops that correct depth and gaps must not throw bodies, nor squeeze them; contacts that stay open do nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/analytic_contacts.h"

namespace blem_sim::dynamics {
namespace {

constexpr double LENGTH = 0.3, DEPTH = 0.01;  // [m]
const Vector3 BAR(LENGTH, 0.02, 0.02);

ContactConstraint deepContact(int body, const Vector3& point, const Vector3& normal, std::uint64_t id) {
  return contactOf(body, WORLD_BODY, point, normal.normalized(), DEPTH, {0}, id);
}

/** A bar along x on a hinge about y at its end, in weightlessness. */
struct HingedBar {
  World world{Vector3::Zero(), {}};
  int bar = world.addBody(boxBody("bar", 1, BAR, {LENGTH / 2, 0, 0}));
  HingedBar() {
    JointSpec hinge;
    hinge.child = bar;
    hinge.axis = Vector3::UnitY();
    world.addJoint(hinge);
  }
};

/** Energy [J] of a kilogram that moves four times as fast as depth is corrected. */
double boundOfEnergy() { return 8 * std::pow(SolverSettings().max_correction_speed, 2); }

class Lever : public ::testing::TestWithParam<double> {};

// The contact pushes nearly along the bar: its point leaves the other surface only if the bar turns 1 / lever times as fast.
TEST_P(Lever, OfADeepContactDoesNotThrowAnArm) {
  HingedBar arm;
  const ContactConstraint contact = deepContact(arm.bar, {LENGTH, 0, 0}, {1, 0, GetParam()}, 1);
  for (int k = 0; k < 3; ++k) {
    arm.world.step(1e-3, {contact}, std::vector<JointDrive>(1));
    EXPECT_LT(arm.world.kineticEnergy(), boundOfEnergy()) << k;
  }
}
INSTANTIATE_TEST_SUITE_P(OfDepth, Lever, ::testing::Values(0.3, 1e-2, 1e-3, 1e-5, 1e-8));

// A point of a turning arm sweeps across a surface whose gap it does not use up. Friction there would hold it hard, if anything pushed.
TEST(EnergyBounds, ContactsThatStayOpenDoNotHoldAnArm) {
  constexpr double SPIN = 30, REACH = 0.55, DT = 3e-4;  // [rad/s, m, s]
  for (const double lever : {1e-4, 1e-3, 3e-3, 0.02})
    for (const double spare : {1e-3, 0.05, 0.5}) {  // of the way towards the surface
      HingedBar arm;
      BodyState state = arm.world.bodyState(arm.bar);
      state.w_WB = {0, SPIN, 0};
      state.v_WCom = state.w_WB.cross(state.X_WB.translation());
      arm.world.setBodyState(arm.bar, state);
      const double gap = (1 + spare) * SPIN * lever * DT;
      const ContactConstraint contact = contactOf(arm.bar, WORLD_BODY, {lever, 0, -REACH}, Vector3::UnitZ(), -gap, {0.5}, 1);
      const SolveResult& result = arm.world.step(DT, {contact}, std::vector<JointDrive>(1));
      EXPECT_EQ(result.contact_forces[0].norm(), 0) << lever << " m, " << spare;
      EXPECT_NEAR(arm.world.bodyState(arm.bar).w_WB.y(), SPIN, 1e-9) << lever << " m, " << spare;
    }
}

// Each of many contacts pushes little, all of them together as hard as one.
TEST(EnergyBounds, ManyContactsDoNotThrowAnArm) {
  HingedBar arm;
  std::vector<ContactConstraint> contacts;
  for (int i = 0; i < 100; ++i) contacts.push_back(deepContact(arm.bar, {LENGTH, 0, 0}, {1, 0, 0.03}, 1 + i));
  arm.world.step(1e-3, contacts, std::vector<JointDrive>(1));
  EXPECT_LT(arm.world.kineticEnergy(), boundOfEnergy());
}

// Two contacts a millimetre apart that push against each other would turn the bar, each at its speed.
TEST(EnergyBounds, ContactsThatContradictEachOtherDoNotThrow) {
  World world(Vector3::Zero(), {});
  const int bar = world.addBody(boxBody("bar", 1, BAR, Vector3::Zero()));
  world.step(1e-3, {deepContact(bar, {0, 0, -0.01}, {0, 0, 1}, 1), deepContact(bar, {1e-3, 0, 0.01}, {0, 0, -1}, 2)}, {});
  EXPECT_LT(world.kineticEnergy(), boundOfEnergy());
}

/** Angles of a groove's walls from upright [rad]; friction; turn of the cube at the start [rad]. */
struct Walls {
  double left, right, friction, turned;
};
class Groove : public ::testing::TestWithParam<Walls> {};

// A cube that friction locks in a groove is balanced under any squeeze. Correcting depth must not build one up.
TEST_P(Groove, SqueezesACubeByNoMoreThanItsWeightAsksFor) {
  const Walls& walls = GetParam();
  const Vector3 size(0.1, 0.1, 0.1), left(std::cos(walls.left), 0, std::sin(walls.left)),
      right(-std::cos(walls.right), 0, std::sin(walls.right));
  World world({0, 0, -9.81}, {});
  BodySpec spec = boxBody("cube", 1, size, {0, 0, 0.5});
  spec.X_WB = makePose({0, 0, 0.5}, {0, walls.turned, 0});
  const int cube = world.addBody(spec);
  double force = 0;
  for (int k = 0; k < 1000; ++k) {
    std::vector<ContactConstraint> contacts;
    boxOnPlane(world, cube, size, left, 0, {walls.friction}, &contacts);
    const std::size_t of_left = contacts.size();
    boxOnPlane(world, cube, size, right, 0, {walls.friction}, &contacts);
    for (std::size_t i = of_left; i < contacts.size(); ++i) contacts[i].id += 1000;
    const SolveResult& result = world.step(1e-3, contacts, {});
    force = 0;
    for (const Vector3& f : result.contact_forces) force = std::max(force, f.norm());
  }
  EXPECT_LT(force, 15 * 9.81);
  EXPECT_LT(world.bodyState(cube).v_WCom.norm(), 1e-9);
}
INSTANTIATE_TEST_SUITE_P(Angles, Groove,
                         ::testing::Values(Walls{0.7, 0.7, 0.0, 0}, Walls{0.7, 0.7, 0.3, 0}, Walls{0.7, 0.7, 1.0, 0},
                                           Walls{0.2, 0.2, 0.3, 0}, Walls{0.2, 0.2, 1.0, 0}, Walls{0.05, 0.05, 1.0, 0},
                                           Walls{0.785, 0, 1.5, 0}, Walls{0.05, 0.4, 1.0, 0.3}));

// Two bars between two hinges, stretched: their middle has no lever along the bars, and weight pulls across them.
TEST(EnergyBounds, AStretchedLoopKeepsStill) {
  World world({0, 0, -9.81}, {});
  const Vector3 bar(0.25, 0.02, 0.02);
  const int one = world.addBody(boxBody("one", 1, bar, {0.125, 0, 0})), two = world.addBody(boxBody("two", 1, bar, {0.375, 0, 0}));
  const auto hinge = [&world](int parent, int child, double x) {
    JointSpec joint;
    joint.parent = parent;
    joint.child = child;
    joint.axis = Vector3::UnitY();
    joint.X_PJ = makePose({x, 0, 0});
    world.addJoint(joint);
  };
  hinge(WORLD_BODY, one, 0);
  hinge(one, two, 0.125);
  hinge(WORLD_BODY, two, 0.5);
  const std::vector<JointDrive> drives(3);
  double most = 0;
  for (int k = 0; k < 500; ++k) {
    world.step(1e-3, {}, drives);
    most = std::max(most, world.kineticEnergy());
  }
  EXPECT_LT(most, 2 * boundOfEnergy());
}

}  // namespace
}  // namespace blem_sim::dynamics
