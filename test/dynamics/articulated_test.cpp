// The articulated stepper on its own ground: trees, islands, mimic joints; and against world_step from the same state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

const Vector3 FOOT(0.24, 0.14, 0.04);

SolverSettings stepper(const std::string& name) {
  SolverSettings settings;
  settings.stepper = name;
  return settings;
}

/** A biped of 10 joints on two feet, feet 0.3 m apart, held by implicit motors. */
struct Biped {
  explicit Biped(const SolverSettings& settings) : world(GRAVITY, settings) {
    const int torso = world.addBody(boxBody("torso", 20, {0.2, 0.3, 0.4}, {0, 0, 1.04}));
    for (const double side : {-1.0, 1.0}) {
      const double y = 0.15 * side;
      const int hip = addLink(torso, "hip", 1, {0.1, 0.1, 0.1}, {0, y, 0.8}, {0, y, 0.84}, Vector3::UnitX());
      const int thigh = addLink(hip, "thigh", 3, {0.1, 0.1, 0.36}, {0, y, 0.62}, {0, y, 0.8}, Vector3::UnitY());
      const int shin = addLink(thigh, "shin", 2, {0.08, 0.08, 0.36}, {0, y, 0.26}, {0, y, 0.44}, Vector3::UnitY());
      const int ankle = addLink(shin, "ankle", 0.3, {0.05, 0.05, 0.05}, {0, y, 0.06}, {0, y, 0.08}, Vector3::UnitY());
      feet.push_back(addLink(ankle, "foot", 1, FOOT, {0.02, y, 0.02}, {0, y, 0.06}, Vector3::UnitX()));
    }
  }

  int addLink(int parent, const std::string& name, double mass, const Vector3& size, const Vector3& centre, const Vector3& joint,
              const Vector3& axis) {
    const int body = world.addBody(boxBody(name, mass, size, centre));
    JointSpec spec;
    spec.name = name;
    spec.parent = parent;
    spec.child = body;
    spec.X_PJ = makePose(joint - world.bodySpec(parent).X_WB.translation());
    spec.axis = axis;
    world.addJoint(spec);
    JointDrive drive;
    drive.stiffness = 2000;
    drive.damping = 20;
    drive.dry_friction = 0.5;
    drives.push_back(drive);
    return body;
  }

  const SolveResult& step() {
    contacts.clear();
    for (const int foot : feet) boxOnPlane(world, foot, FOOT, Vector3::UnitZ(), 0, {}, &contacts);
    return world.step(DT, contacts, drives);
  }

  double mass() const {
    double sum = 0;
    for (int b = 0; b < world.bodyCount(); ++b) sum += world.bodySpec(b).inertial.mass;
    return sum;
  }
  /** [m] largest distance between the two bodies' idea of where a joint is. */
  double jointGap() const {
    double worst = 0;
    for (int j = 0; j < world.jointCount(); ++j) {
      const JointSpec& spec = world.jointSpec(j);
      const Vector3 parent = world.bodyState(spec.parent).X_WB * spec.X_PJ.translation();
      const Vector3 on_child = world.bodySpec(spec.parent).X_WB * spec.X_PJ.translation() - world.bodySpec(spec.child).X_WB.translation();
      worst = std::max(worst, (world.bodyState(spec.child).X_WB * on_child - parent).norm());
    }
    return worst;
  }
  double jointSpeed() const {
    double worst = 0;
    for (int j = 0; j < world.jointCount(); ++j) worst = std::max(worst, std::abs(world.jointState(j).velocity));
    return worst;
  }

  World world;
  std::vector<int> feet;
  std::vector<JointDrive> drives;
  std::vector<ContactConstraint> contacts;
};

double verticalForce(const SolveResult& result) {
  double sum = 0;
  for (const Vector3& f : result.contact_forces) sum += f.z();
  return sum;
}

TEST(Articulated, BipedStandsStill) {
  Biped biped(stepper("articulated"));
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < 3000; ++i) {
    const SolveResult& result = biped.step();
    ASSERT_TRUE(result.finite);
    if (i < 2000) continue;
    low = std::min(low, verticalForce(result));
    high = std::max(high, verticalForce(result));
  }
  const double weight = biped.mass() * 9.81;
  EXPECT_NEAR(low, weight, 1e-8 * weight);
  EXPECT_NEAR(high, weight, 1e-8 * weight);
  EXPECT_LT(biped.jointGap(), 1e-12);
  EXPECT_LT(biped.jointSpeed(), 1e-9);
}

// Both steppers solve the same step: while every contact sticks they agree to world_step's own softness, which is made small here.
TEST(Articulated, AgreesWithWorldStepWhereContactsStick) {
  SolverSettings reference_settings = stepper("world_step");
  reference_settings.cfm = 1e-8;
  Biped one(stepper("articulated")), other(reference_settings);
  for (int i = 0; i < 1500; ++i) one.step();
  for (int b = 0; b < one.world.bodyCount(); ++b) other.world.setBodyState(b, one.world.bodyState(b));
  const double force = verticalForce(one.step()), reference = verticalForce(other.step());
  EXPECT_NEAR(force, reference, 1e-3 * reference);
  for (int j = 0; j < one.world.jointCount(); ++j)
    EXPECT_NEAR(one.world.jointState(j).velocity, other.world.jointState(j).velocity, 1e-3) << j;
}

TEST(Articulated, StackIsExact) {
  World world(GRAVITY, stepper("articulated"));
  const Vector3 size(0.1, 0.1, 0.1);
  for (int i = 0; i < 10; ++i) world.addBody(boxBody("cube", 1, size, {0.002 * (i % 2), 0.001 * (i % 3), 0.06 + 0.11 * i}));
  for (int k = 0; k < 3000; ++k) {
    std::vector<ContactConstraint> contacts;
    boxOnPlane(world, 0, size, Vector3::UnitZ(), 0, {}, &contacts);
    for (int i = 1; i < 10; ++i) boxOnBox(world, i, size, i - 1, size, {}, &contacts);
    ASSERT_TRUE(world.step(DT, contacts, {}).finite);
  }
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(world.bodyState(i).X_WB.translation().z(), 0.05 + 0.1 * i, 1e-9) << i;
    EXPECT_NEAR(world.bodyState(i).X_WB.translation().x(), 0.002 * (i % 2), 1e-8) << i;
    EXPECT_LT(world.bodyState(i).v_WCom.norm(), 1e-10) << i;
  }
}

class ArticulatedSlope : public ::testing::TestWithParam<int> {};

// Mu 0.5 slips at 26.565 degrees, in every direction the same.
TEST_P(ArticulatedSlope, HoldsBelowAndSlidesAbove) {
  const double direction = GetParam() * M_PI / 8;
  for (const double degrees : {26.5, 26.6, 30.0}) {
    const double angle = degrees * M_PI / 180;
    const Vector3 down(std::cos(direction), std::sin(direction), 0);
    World world(9.81 * (std::sin(angle) * down - std::cos(angle) * Vector3::UnitZ()), stepper("articulated"));
    const Vector3 size(0.1, 0.1, 0.1);
    world.addBody(boxBody("box", 1, size, {0, 0, 0.05}));
    Vector3 before = Vector3::Zero();
    for (int k = 0; k < 1000; ++k) {
      if (k == 500) before = world.bodyState(0).v_WCom;
      std::vector<ContactConstraint> contacts;
      boxOnPlane(world, 0, size, Vector3::UnitZ(), 0, {}, &contacts);
      world.step(DT, contacts, {});
    }
    const Vector3 acceleration = (world.bodyState(0).v_WCom - before) / 0.5;
    const double theory = std::max(0.0, 9.81 * (std::sin(angle) - 0.5 * std::cos(angle)));
    EXPECT_NEAR((acceleration - theory * down).norm(), 0, 1e-5 * theory + 1e-9) << degrees;
    if (theory == 0) {
      EXPECT_LT(world.bodyState(0).v_WCom.norm(), 1e-9);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Directions, ArticulatedSlope, ::testing::Range(0, 8));

TEST(Articulated, LightStiffFingersStayCalm) {
  World world(GRAVITY, stepper("articulated"));
  const int palm = world.addBody(boxBody("palm", 1, {0.1, 0.1, 0.1}, Vector3::Zero()));
  const int finger = world.addBody(boxBody("finger", 0.02, {0.01, 0.01, 0.05}, {0.05, 0, 0}));
  JointSpec fix, hinge;
  fix.name = "fix", fix.kind = JointKind::FIXED, fix.child = palm;
  hinge.name = "hinge", hinge.parent = palm, hinge.child = finger, hinge.X_PJ = makePose({0.05, 0, 0.03}), hinge.axis = Vector3::UnitY();
  world.addJoint(fix);
  world.addJoint(hinge);
  std::vector<JointDrive> drives(2);
  drives[1].stiffness = 1e6, drives[1].target_position = 0.5, drives[1].max_effort = 2;
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(world.step(DT, {}, drives).finite);
  EXPECT_NEAR(world.jointState(1).position, 0.5, 1e-6);
  EXPECT_LT(std::abs(world.jointState(1).velocity), 1e-9);
}

// Boxes land on each other, a heavy one last: nothing is thrown, and all comes to rest.
TEST(Articulated, BoxesLandingOnEachOtherComeToRest) {
  World world(GRAVITY, stepper("articulated"));
  const Vector3 size(0.1, 0.1, 0.1);
  for (int i = 0; i < 5; ++i) {
    world.addBody(boxBody("box", i == 4 ? 100 : 1, size, {0.001 * i, 0, 0.3 * (i + 1)}));
  }
  const double start = world.kineticEnergy() + world.potentialEnergy();
  for (int k = 0; k < 3000; ++k) {
    std::vector<ContactConstraint> contacts;
    boxOnPlane(world, 0, size, Vector3::UnitZ(), 0, {}, &contacts);
    for (int i = 1; i < 5; ++i) boxOnBox(world, i, size, i - 1, size, {}, &contacts);
    ASSERT_TRUE(world.step(DT, contacts, {}).finite);
    ASSERT_LT(world.kineticEnergy() + world.potentialEnergy(), start * (1 + 1e-9)) << k;
  }
  EXPECT_LT(world.kineticEnergy(), 1e-12);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(world.bodyState(i).X_WB.translation().z(), 0.05 + 0.1 * i, 1e-6) << i;
}

}  // namespace
}  // namespace blem_sim::dynamics
