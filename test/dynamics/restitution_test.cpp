// Bounces never make energy: bodies that turn, rows of balls, trees, friction; and sensors' readings of a bounce.
#include <gtest/gtest.h>

#include "dynamics/bouncing_bodies.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

Surface surfaceOf(double restitution, double friction) {
  Surface surface;
  surface.restitution = restitution;
  surface.friction = friction;
  return surface;
}

// The cube would gain 21 to 55 % if corners landed in one step and left in the next, each with its own speed.
TEST(Restitution, ATurningCubeKeepsAllItsEnergy) {
  for (int seed = 0; seed < 3; ++seed) {
    BouncingBodies scene(GRAVITY, surfaceOf(1, 0));
    tossCube(&scene, seed);
    const EnergyRun run = followEnergy(&scene, DT, 5000);
    ASSERT_TRUE(run.finite);
    EXPECT_LT(run.worst, 1e-9 * run.start) << seed;
    EXPECT_NEAR(run.end, run.start, 1e-9 * run.start) << seed;
  }
}

struct Law {
  double restitution, friction, impact_friction_factor = 1;
};

class Bounces : public ::testing::TestWithParam<Law> {};

// 1e-5 J: between bounces the solve steps straight along the arc of a corner that is rolled over, and takes friction at the step's end
// while slip turns round; it does so without restitution, too.
TEST_P(Bounces, NeverGain) {
  for (void (*const toss)(BouncingBodies*, int) : {tossCube, tossThree}) {
    for (int seed = 0; seed < 2; ++seed) {
      Surface surface = surfaceOf(GetParam().restitution, GetParam().friction);
      surface.impact_friction_factor = GetParam().impact_friction_factor;
      BouncingBodies scene(GRAVITY, surface);
      toss(&scene, seed);
      const EnergyRun run = followEnergy(&scene, DT, 3000);
      ASSERT_TRUE(run.finite);
      EXPECT_LT(run.worst, 1e-5);
      EXPECT_LT(run.end, run.start * (1 + 1e-9));
      EXPECT_TRUE(GetParam().restitution == 1 || run.end < 0.9 * run.start);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, Bounces,
                         ::testing::Values(Law{0.2, 0}, Law{0.2, 0.3}, Law{0.5, 1}, Law{0.8, 0}, Law{0.8, 0.3}, Law{1, 0.3}, Law{1, 1},
                                           Law{0, 0.3, 0.5}, Law{0.2, 0.3, 0.75}, Law{0.8, 1, 0.2}, Law{1, 0.5, 0.5}, Law{1, 1, 0}));

// A finger on a slide that meets a wall head on cannot be rubbed: its friction was 0 / 0, and the simulation stopped.
TEST(Restitution, ASliderBouncesOffAWall) {
  BouncingBodies scene(Vector3::Zero(), surfaceOf(0.8, 0.5));
  JointSpec slide;
  slide.name = "slide";
  slide.kind = JointKind::PRISMATIC;
  slide.child = scene.addSphere(1, 0.05, {0, 0, 0});
  slide.axis = Vector3::UnitX();
  scene.world.addJoint(slide, 0);
  scene.walls.push_back({-Vector3::UnitX(), -0.1});
  BodyState state = scene.world.bodyState(slide.child);
  state.v_WCom = Vector3::UnitX();
  scene.world.setBodyState(slide.child, state);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(scene.step(DT).finite) << i;
  EXPECT_NEAR(scene.world.bodyState(slide.child).v_WCom.x(), -0.8, 1e-9);
}

class Cradles : public ::testing::TestWithParam<double> {};

// 0.80 of the energy was left, and several balls went off.
TEST_P(Cradles, AsManyLeaveAsCame) {
  for (int swung = 1; swung <= 3; ++swung) {
    Cradle cradle(swung, GetParam());
    const double start = cradle.scene.energy(DT);
    for (int half = 1; half <= 2; ++half) {
      cradle.swing(DT);
      EXPECT_NEAR(cradle.scene.energy(DT), start, 1e-3 * start) << swung;
      for (int ball = 0; ball < Cradle::BALLS; ++ball) {
        const bool away = half == 1 ? ball >= Cradle::BALLS - swung : ball < swung;
        EXPECT_NEAR(std::abs(cradle.angle(ball)), away ? Cradle::ANGLE : 0, 0.02 * Cradle::ANGLE) << swung << " " << ball;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gaps, Cradles, ::testing::Values(0, 1e-5, 1e-4, 1e-3));

// Balls hit one after the other, although they touch: a ball that leaves a pair hits the next.
TEST(Restitution, ARowOfUnequalBallsPassesTheImpactOn) {
  const double e = 0.7, masses[] = {1, 0.4, 2};
  BouncingBodies scene(Vector3::Zero(), surfaceOf(e, 0.5));
  for (int i = 0; i < 3; ++i) scene.addSphere(masses[i], 0.02, {0.04 * i + (i == 0 ? -0.01 : 0), 0, 0});
  scene.setVelocity(0, {1, 0, 0}, Vector3::Zero());
  double v[] = {1, 0, 0};
  const auto collide = [&](int a, int b) {
    const double impulse = (1 + e) * (v[a] - v[b]) / (1 / masses[a] + 1 / masses[b]);
    v[a] -= impulse / masses[a];
    v[b] += impulse / masses[b];
  };
  for (int pair = 0; v[0] > v[1] || v[1] > v[2]; pair = 1 - pair)
    if (v[pair] > v[pair + 1]) collide(pair, pair + 1);
  for (int i = 0; i < 50; ++i) scene.step(DT);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(scene.world.bodyState(i).v_WCom.x(), v[i], 1e-9) << i;
}

TEST(Restitution, AFlatLandingStaysFlatAndTellsItsForce) {
  const double e = 0.6;
  BouncingBodies scene(GRAVITY, surfaceOf(e, 0.5));
  scene.walls = {{Vector3::UnitZ(), 0}};
  const int cube = scene.addBox(2, {0.1, 0.2, 0.05}, {0, 0, 0.2});
  double impulse = 0, fall = 0;
  for (int i = 0; i < 1000 && impulse == 0; ++i) {
    fall = -scene.world.bodyState(cube).v_WCom.z();
    const SolveResult& result = scene.step(DT);
    for (const Vector3& force : result.contact_forces) impulse += DT * force.z();
  }
  const BodyState state = scene.world.bodyState(cube);
  EXPECT_NEAR(state.v_WCom.z(), e * fall, 0.02 * fall);
  EXPECT_LT(state.w_WB.norm(), 1e-12);
  EXPECT_LT(state.v_WCom.head<2>().norm(), 1e-12);
  EXPECT_NEAR(impulse, 2 * (state.v_WCom.z() + fall + 9.81 * DT), 1e-9);
}

// The upper half of a bouncing pair is stopped and thrown through the joint.
TEST(Restitution, AJointFeelsTheImpactPassThrough) {
  BouncingBodies scene(GRAVITY, surfaceOf(1, 0));
  scene.walls = {{Vector3::UnitZ(), 0}};
  const int lower = scene.addBox(1, {0.2, 0.2, 0.1}, {0, 0, 0.2}), upper = scene.add(3, Vector3::Constant(0.01), {0, 0, 0.3}, {});
  scene.hinge(lower, upper, {0, 0, 0.25}, Vector3::UnitY());
  Vector3 before = Vector3::Zero();
  double pull = 0;
  for (int i = 0; i < 1000 && pull < 1; ++i) {
    before = scene.world.bodyState(upper).v_WCom;
    pull = scene.step(DT).joint_wrenches[0].force.z();
  }
  const Vector3 after = scene.world.bodyState(upper).v_WCom;
  EXPECT_GT(after.z(), 1);
  EXPECT_NEAR(pull, 3 * ((after - before).z() / DT + 9.81), 1e-6);
}

TEST(Restitution, ComesToRestAndStaysThere) {
  BouncingBodies scene(GRAVITY, surfaceOf(0.8, 0.3));
  tossCube(&scene, 1);
  for (int i = 0; i < 6000; ++i) scene.step(DT);
  for (int i = 0; i < 1000; ++i) {
    scene.step(DT);
    ASSERT_LT(scene.world.bodyState(0).v_WCom.norm(), 1e-9);
  }
}

// Friction stops the slip of a ball that has the time for it, or takes mu times the normal impulse.
TEST(Restitution, FrictionOfAnImpactIsCoulombs) {
  const double e = 0.5, radius = 0.05;
  for (const double mu : {0.05, 1.0}) {
    BouncingBodies scene(Vector3::Zero(), surfaceOf(e, mu));
    scene.walls = {{Vector3::UnitZ(), 0}};
    scene.addSphere(1, radius, {0, 0, radius + 0.01});
    scene.setVelocity(0, {1, 0, -2}, Vector3::Zero());
    for (int i = 0; i < 20; ++i) scene.step(DT);
    const BodyState state = scene.world.bodyState(0);
    const double push = std::min(mu * (1 + e) * 2, 1 / 3.5);
    EXPECT_NEAR(state.v_WCom.z(), e * 2, 1e-12);
    EXPECT_NEAR(state.v_WCom.x(), 1 - push, 1e-9);
    EXPECT_NEAR(state.w_WB.y(), push / (0.4 * radius), 1e-7);
  }
}

// Sliding contacts keep their own friction: the ball's impact rubs with a half of it, with and without a bounce.
TEST(Restitution, FrictionOfImpactsMayBeLowerThanThatOfSliding) {
  const double mu = 0.1, factor = 0.5, radius = 0.05;
  for (const double e : {0.0, 0.5}) {
    Surface surface = surfaceOf(e, mu);
    surface.impact_friction_factor = factor;
    BouncingBodies scene(Vector3::Zero(), surface);
    scene.walls = {{Vector3::UnitZ(), 0}};
    scene.addSphere(1, radius, {0, 0, radius + 0.01});
    scene.setVelocity(0, {1, 0, -2}, Vector3::Zero());
    for (int i = 0; i < 20; ++i) scene.step(DT);
    const BodyState state = scene.world.bodyState(0);
    const double push = factor * mu * (1 + e) * 2;
    EXPECT_NEAR(state.v_WCom.z(), e * 2, 1e-9) << e;
    EXPECT_NEAR(state.v_WCom.x(), 1 - push, 1e-9) << e;
    EXPECT_NEAR(state.w_WB.y(), push / (0.4 * radius), 1e-7) << e;
  }
  Surface surface = surfaceOf(0.5, mu);
  surface.impact_friction_factor = factor;
  BouncingBodies scene(GRAVITY, surface);
  scene.walls = {{Vector3::UnitZ(), 0}};
  scene.addBox(1, {0.1, 0.1, 0.02}, {0, 0, 0.01});
  scene.setVelocity(0, {1, 0, 0}, Vector3::Zero());
  for (int i = 0; i < 500; ++i) scene.step(DT);
  EXPECT_NEAR(scene.world.bodyState(0).v_WCom.x(), 1 - 0.5 * mu * 9.81, 1e-6);
}

// The factor acts on impacts that are faster than impact_friction_speed, 2 m/s here.
TEST(Restitution, FrictionOfSlowImpactsIsThatOfSliding) {
  const double mu = 0.1, factor = 0.5, radius = 0.05, e = 0.5;
  for (const double speed : {1.9, 2.1}) {
    Surface surface = surfaceOf(e, mu);
    surface.impact_friction_factor = factor;
    surface.impact_friction_speed = 2;
    BouncingBodies scene(Vector3::Zero(), surface);
    scene.walls = {{Vector3::UnitZ(), 0}};
    scene.addSphere(1, radius, {0, 0, radius + 0.01});
    scene.setVelocity(0, {2, 0, -speed}, Vector3::Zero());
    for (int i = 0; i < 20; ++i) scene.step(DT);
    const double push = (speed > 2 ? factor : 1) * mu * (1 + e) * speed;
    EXPECT_NEAR(scene.world.bodyState(0).v_WCom.x(), 2 - push, 1e-9) << speed;
  }
}

// The touch bounces; a cube too slow for that rests on the springs.
TEST(Restitution, ACompliantSurfaceBouncesAtTheTouch) {
  Surface surface = surfaceOf(0.5, 0.5);
  surface.stiffness = 2e4, surface.damping = 200;
  BouncingBodies scene(GRAVITY, surface);
  scene.walls = {{Vector3::UnitZ(), 0}};
  scene.addBox(1, {0.1, 0.1, 0.1}, {0, 0, 0.25});
  double apex = 0, worst = 0, energy = scene.energy(DT);
  bool up = false;
  for (int i = 0; i < 5000; ++i) {
    scene.step(DT);
    const BodyState state = scene.world.bodyState(0);
    up = up || state.v_WCom.z() > 0.1;
    if (up) apex = std::max(apex, state.X_WB.translation().z() - 0.05);
    if (i < 300) worst = std::max(worst, scene.energy(DT) - energy);
    energy = scene.energy(DT);
  }
  EXPECT_NEAR(apex, 0.25 * 0.2, 1e-3 * 0.05);
  EXPECT_LT(worst, 1e-9);
  EXPECT_NEAR(scene.world.bodyState(0).X_WB.translation().z(), 0.05 - 9.81 / 8e4, 1e-9);
}

}  // namespace
}  // namespace blem_sim::dynamics
