// Friction, restitution and compliance of contacts against theory.
#include <gtest/gtest.h>

#include <algorithm>

#include "dynamics/analytic_contacts.h"
#include "scene/contact_law.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

/** A cube on the plane z = 0. */
struct CubeOnPlane {
  CubeOnPlane(const Vector3& gravity, double height, const Surface& s, const SolverSettings& settings = {})
      : world(gravity, settings), surface(s), cube(world.addBody(boxBody("cube", 1, CUBE, {0, 0, 0.05 + height}))) {}

  const SolveResult& step() {
    contacts.clear();
    boxOnPlane(world, cube, CUBE, Vector3::UnitZ(), 0, surface, &contacts);
    const SolveResult& result = world.step(DT, contacts, {});
    lcp_errors += result.lcp_errors;
    return result;
  }
  Vector3 position() const { return world.bodyState(cube).X_WB.translation(); }
  Vector3 velocity() const { return world.bodyState(cube).v_WCom; }

  World world;
  Surface surface;
  int cube;
  std::vector<ContactConstraint> contacts;
  int lcp_errors = 0;
};

Vector3 slopeGravity(double degrees, double direction) {
  const double angle = degrees * M_PI / 180;
  return 9.81 * Vector3(std::sin(angle) * std::cos(direction), std::sin(angle) * std::sin(direction), -std::cos(angle));
}

class Slope : public ::testing::TestWithParam<int> {
 protected:
  double direction() const { return GetParam() * M_PI / 8; }  // 22.5 degrees apart
};

TEST_P(Slope, HoldsBelowTheFrictionAngle) {
  CubeOnPlane scene(slopeGravity(26.4, direction()), 0, {});
  for (int i = 0; i < 1000; ++i) scene.step();
  const Vector3 before = scene.position();
  scene.lcp_errors = 0;  // of the first second, which starts exactly degenerate: such a step is done again, softer
  for (int i = 0; i < 1000; ++i) scene.step();
  EXPECT_LT((scene.position() - before).norm(), 1e-12);  // [m] in one second
  EXPECT_EQ(scene.lcp_errors, 0);
}

TEST_P(Slope, SlidesStraightAboveIt) {
  const double angle = 27 * M_PI / 180;
  CubeOnPlane scene(slopeGravity(27, direction()), 0, {});
  for (int i = 0; i < 500; ++i) scene.step();
  const Vector3 start = scene.velocity();
  for (int i = 0; i < 1000; ++i) scene.step();
  const Vector3 acceleration = scene.velocity() - start;
  const double theory = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
  const Vector3 downhill(std::cos(direction()), std::sin(direction()), 0);
  EXPECT_NEAR(acceleration.dot(downhill) / theory, 1, 1e-4);
  EXPECT_LT((acceleration - downhill * acceleration.dot(downhill)).norm(), 1e-4 * theory);
  EXPECT_EQ(scene.lcp_errors, 0);
}

INSTANTIATE_TEST_SUITE_P(EightDirections, Slope, ::testing::Range(0, 8));

class Bounce : public ::testing::TestWithParam<double> {};

TEST_P(Bounce, ApexIsRestitutionSquared) {
  const double e = GetParam(), height = 0.5;
  Surface surface;
  surface.restitution = e;
  CubeOnPlane scene({0, 0, -9.81}, height, surface);
  while (scene.velocity().z() <= 0 && scene.position().z() > 0.0501) scene.step();
  double apex = 0;
  for (int i = 0; i < 5; ++i) scene.step();  // landed and left
  double last = scene.position().z();
  while (scene.velocity().z() > 0) {
    scene.step();
    apex = std::max(last, scene.position().z()) - 0.05;
    last = scene.position().z();
  }
  EXPECT_NEAR(apex / height, e * e, 0.01 * e * e) << apex;
}

INSTANTIATE_TEST_SUITE_P(Restitutions, Bounce, ::testing::Values(0.25, 0.375, 0.5, 0.75, 1.0));

TEST(Restitution, FullOneKeepsItsEnergyOverTenBounces) {
  Surface surface;
  surface.restitution = 1;
  CubeOnPlane scene({0, 0, -9.81}, 0.5, surface);
  int bounces = 0;
  double apex = 0;
  bool rising = false;
  while (bounces < 11) {
    scene.step();
    const bool rises = scene.velocity().z() > 0;
    if (rising && !rises) apex = scene.position().z() - 0.05, ++bounces;
    rising = rises;
  }
  EXPECT_NEAR(apex, 0.5, 0.005);
}

TEST(Restitution, NoneStaysDown) {
  CubeOnPlane scene({0, 0, -9.81}, 0.5, {});
  for (int i = 0; i < 400; ++i) scene.step();
  double highest = 0;
  for (int i = 0; i < 300; ++i) {
    scene.step();
    highest = std::max(highest, scene.position().z() - 0.05);
  }
  EXPECT_LT(highest, 1e-6);
}

TEST(Compliance, SagsByWeightOverStiffness) {
  Surface surface;
  surface.stiffness = 2e4, surface.damping = 200;
  CubeOnPlane scene({0, 0, -9.81}, 0, surface);
  for (int i = 0; i < 2000; ++i) scene.step();
  EXPECT_NEAR(0.05 - scene.position().z(), 9.81 / (4 * 2e4), 1e-9);
  EXPECT_LT(scene.velocity().norm(), 1e-9);
}

TEST(Compliance, OscillatesAtItsFrequency) {
  Surface surface;
  surface.stiffness = 1000, surface.damping = 0.001, surface.friction = 0;
  SolverSettings settings;
  CubeOnPlane scene({0, 0, -9.81}, 0, surface, settings);
  const double omega = std::sqrt(4 * 1000 / 1.0), sag = 9.81 / 4000;
  int crossings = 0;
  double first = 0, last = 0;
  for (int i = 0; i < 1000; ++i) {
    const double before = scene.position().z() - 0.05 + sag;
    scene.step();
    const double after = scene.position().z() - 0.05 + sag;
    if (before <= 0 && after > 0) {
      last = (i + before / (before - after)) * DT;
      if (crossings++ == 0) first = last;
    }
  }
  ASSERT_GT(crossings, 3);
  EXPECT_NEAR((last - first) / (crossings - 1), 2 * M_PI / omega, 0.02 * 2 * M_PI / omega);
}

TEST(ContactRows, SpeculativeGapBoundsTheClosingSpeed) {
  ContactConstraint c = contactOf(0, WORLD_BODY, Vector3::Zero(), Vector3::UnitZ(), -5e-4, {}, 1);
  EXPECT_DOUBLE_EQ(contactRows(c, {}, nullptr, DT, {}).normal_speed, -0.5);
  c.depth = 1e-4;
  EXPECT_DOUBLE_EQ(contactRows(c, {}, nullptr, DT, {}).normal_speed, 0.02);
  c.depth = 1e-2;
  EXPECT_DOUBLE_EQ(contactRows(c, {}, nullptr, DT, {}).normal_speed, 0.1);
}

TEST(ContactRows, FirstAxisFollowsSlipThenForceThenSlipToBe) {
  const ContactConstraint c = contactOf(0, WORLD_BODY, Vector3::Zero(), Vector3::UnitZ(), 0, {}, 1);
  const ContactMemo memo{1, Vector3(0, 3, 4), 0};
  const ContactMotion fast{{0.3, 0.4, -1}, {0, 0, 0}}, still{{0, 0, -1}, {2, 0, 0}};
  EXPECT_NEAR((contactRows(c, fast, &memo, DT, {}).first_axis + Vector3(0.6, 0.8, 0)).norm(), 0, 1e-5);
  EXPECT_NEAR((contactRows(c, still, &memo, DT, {}).first_axis - Vector3::UnitY()).norm(), 0, 1e-15);
  EXPECT_NEAR((contactRows(c, still, nullptr, DT, {}).first_axis + Vector3::UnitX()).norm(), 0, 1e-15);
  EXPECT_TRUE(contactRows(c, fast, &memo, DT, {}).tangent_velocity.isZero(0));
  EXPECT_NEAR((contactRows(c, still, &memo, DT, {}).tangent_velocity - Vector3(0, 3e-6, 0)).norm(), 0, 1e-18);
}

}  // namespace
}  // namespace blem_sim::dynamics
