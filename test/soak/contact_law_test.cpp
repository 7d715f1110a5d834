// One cube on a plane against theory: slopes in eight directions, bounces of every restitution.
#include <gtest/gtest.h>

#include "dynamics/analytic_contacts.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

const Vector3 CUBE(0.1, 0.1, 0.1);
constexpr double DT = 1e-3, G = 9.81;
constexpr double MARGIN = 5e-3;  // [m] contacts exist before touch: more than one step of the fastest fall here

struct CubeOnPlane {
  CubeOnPlane(const Vector3& gravity, double height, const dynamics::Surface& s) : world(gravity, soakSettings()), surface(s) {
    world.addBody(dynamics::boxBody("cube", 1, CUBE, {0, 0, 0.05 + height}));
  }
  bool step() {
    std::vector<dynamics::ContactConstraint> contacts;
    dynamics::boxOnPlane(world, 0, CUBE, Vector3::UnitZ(), 0, surface, &contacts, MARGIN);
    return world.step(DT, contacts, {}).finite;
  }
  Vector3 velocity() const { return world.bodyState(0).v_WCom; }
  double height() const { return world.bodyState(0).X_WB.translation().z() - 0.05; }
  double energy() const { return world.kineticEnergy() + G * height(); }

  dynamics::World world;
  dynamics::Surface surface;
};

class SoakSlope : public ::testing::TestWithParam<int> {
 protected:
  Vector3 down() const { return {std::cos(GetParam() * M_PI / 8), std::sin(GetParam() * M_PI / 8), 0}; }
  Vector3 gravity(double degrees) const {
    const double angle = degrees * M_PI / 180;
    return G * (std::sin(angle) * down() - std::cos(angle) * Vector3::UnitZ());
  }
};

// Mu 0.5 slips at 26.565 degrees.
TEST_P(SoakSlope, HoldsBelowTheFrictionAngle) {
  CubeOnPlane cube(gravity(26.5), 0, {});
  for (int i = 0; i < soakSteps(10, 1); ++i) ASSERT_TRUE(cube.step());
  figure("slope 26.5 deg, direction " + std::to_string(GetParam()) + ": speed", cube.velocity().norm(), "m/s");
  EXPECT_LT(cube.velocity().norm(), 1e-9);
}

TEST_P(SoakSlope, SlidesAboveItAsTheorySays) {
  for (const double degrees : {26.6, 30.0}) {
    CubeOnPlane cube(gravity(degrees), 0, {});
    for (int i = 0; i < 500; ++i) ASSERT_TRUE(cube.step());
    const Vector3 before = cube.velocity();
    const int steps = soakSteps(5, 1);
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(cube.step());
    const double angle = degrees * M_PI / 180, theory = G * (std::sin(angle) - 0.5 * std::cos(angle));
    const double off = ((cube.velocity() - before) / (DT * steps) - theory * down()).norm() / theory;
    figure("slope " + std::to_string(degrees).substr(0, 4) + " deg, direction " + std::to_string(GetParam()) + ": acceleration off", off,
           "");
    EXPECT_LE(off, 1e-5);
  }
}
INSTANTIATE_TEST_SUITE_P(Directions, SoakSlope, ::testing::Range(0, 8));

class SoakBounce : public ::testing::TestWithParam<double> {};

TEST_P(SoakBounce, ApexIsRestitutionSquared) {
  const double e = GetParam(), drop = 0.5;
  dynamics::Surface surface;
  surface.restitution = e;
  CubeOnPlane cube({0, 0, -G}, drop, surface);
  bool landed = false, rising = false;
  double apex = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(cube.step());
    landed = landed || cube.velocity().z() > 0;  // it turns up to a step's way above the plane
    if (!landed) continue;
    if (rising && cube.velocity().z() <= 0) break;
    rising = rising || cube.velocity().z() > 1e-3;
    if (rising) apex = std::max(apex, cube.height());
  }
  figure("bounce e " + std::to_string(e) + ": apex over e^2 h, less 1", apex / (e * e * drop) - 1, "");
  EXPECT_NEAR(apex, e * e * drop, 0.01 * e * e * drop);
}
INSTANTIATE_TEST_SUITE_P(Restitutions, SoakBounce, ::testing::Values(0.25, 0.375, 0.5, 0.75, 1.0));

TEST(SoakBounceNone, StaysDown) {
  CubeOnPlane cube({0, 0, -G}, 0.5, {});
  double apex = 0;
  bool landed = false;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(cube.step());
    if (landed) apex = std::max(apex, cube.height());
    landed = landed || cube.height() < 1e-9;
  }
  figure("bounce e 0: apex", apex, "m");
  EXPECT_TRUE(landed);
  EXPECT_LT(apex, 1e-6);
}

TEST(SoakBounceFull, KeepsItsEnergyOverTenBounces) {
  dynamics::Surface surface;
  surface.restitution = 1;
  CubeOnPlane cube({0, 0, -G}, 0.5, surface);
  const double start = cube.energy();
  int bounces = 0;
  bool falling = true;
  for (int i = 0; i < 10000 && bounces < 10; ++i) {
    ASSERT_TRUE(cube.step());
    if (falling && cube.velocity().z() > 1) ++bounces;
    falling = cube.velocity().z() < 0 || (falling && cube.velocity().z() <= 1);
  }
  ASSERT_EQ(bounces, 10);
  figure("bounce e 1: energy after 10, less 1", cube.energy() / start - 1, "");
  EXPECT_NEAR(cube.energy(), start, 0.01 * start);
}

}  // namespace
}  // namespace blem_sim
