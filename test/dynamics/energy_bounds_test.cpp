// Contacts that correct depth must not throw what they correct.
#include <gtest/gtest.h>

#include "analytic_contacts.h"

namespace blem_sim {
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

/** [J] of a kilogram that moves four times as fast as depth is corrected. */
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

// Two contacts a millimetre apart that push against each other would turn the bar, each at its speed.
TEST(EnergyBounds, ContactsThatContradictEachOtherDoNotThrow) {
  World world(Vector3::Zero(), {});
  const int bar = world.addBody(boxBody("bar", 1, BAR, Vector3::Zero()));
  world.step(1e-3, {deepContact(bar, {0, 0, -0.01}, {0, 0, 1}, 1), deepContact(bar, {1e-3, 0, 0.01}, {0, 0, -1}, 2)}, {});
  EXPECT_LT(world.kineticEnergy(), boundOfEnergy());
}

}  // namespace
}  // namespace blem_sim
