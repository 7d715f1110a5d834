// Boxes at rest on each other: drift and sag against theory.
#include <gtest/gtest.h>

#include <algorithm>

#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

struct Stack {
  explicit Stack(int count, double gap, double offset = 0, const SolverSettings& settings = {}) : world(GRAVITY, settings) {
    double z = gap + 0.05;
    for (int i = 0; i < count; ++i, z += 0.1 + gap)
      world.addBody(boxBody("cube" + std::to_string(i), 1, CUBE, {offset * ((i * 7) % 5 - 2), offset * ((i * 3) % 5 - 2), z}));
  }

  const SolveResult& step(double dt = 1e-3) {
    contacts.clear();
    boxOnPlane(world, 0, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
    for (int i = 1; i < world.bodyCount(); ++i) boxOnBox(world, i, CUBE, i - 1, CUBE, {}, &contacts);
    const SolveResult& result = world.step(dt, contacts, {});
    lcp_errors += result.lcp_errors;
    return result;
  }

  /** [m] worst deviation from where cubes without sag or drift stand. */
  double sideways() const {
    double worst = 0;
    for (int i = 0; i < world.bodyCount(); ++i)
      worst = std::max(worst, (world.bodyState(i).X_WB.translation() - world.bodySpec(i).X_WB.translation()).head<2>().norm());
    return worst;
  }
  double heightError() const {
    double worst = 0;
    for (int i = 0; i < world.bodyCount(); ++i)
      worst = std::max(worst, std::abs(world.bodyState(i).X_WB.translation().z() - (0.05 + 0.1 * i)));
    return worst;
  }
  double speed() const {
    double worst = 0;
    for (int i = 0; i < world.bodyCount(); ++i) worst = std::max(worst, world.bodyState(i).v_WCom.norm());
    return worst;
  }

  World world;
  std::vector<ContactConstraint> contacts;
  int lcp_errors = 0;
};

void expectStands(int count, double offset, int steps) {
  Stack stack(count, 0.01, offset);
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(stack.step().finite);
  EXPECT_LT(stack.sideways(), 1e-4);
  EXPECT_LT(stack.heightError(), 1e-4);
  EXPECT_LT(stack.speed(), 1e-6);
  EXPECT_EQ(stack.lcp_errors, 0);
  ::testing::Test::RecordProperty("sideways_um", std::to_string(1e6 * stack.sideways()));
  ::testing::Test::RecordProperty("height_um", std::to_string(1e6 * stack.heightError()));
  std::printf("    %d cubes, %d steps: sideways %.3g um, height %.3g um, speed %.3g m/s\n", count, steps, 1e6 * stack.sideways(),
              1e6 * stack.heightError(), stack.speed());
}

TEST(Stacks, OneCubeRestsWithoutDrift) {
  Stack stack(1, 0);
  for (int i = 0; i < 10000; ++i) stack.step();
  EXPECT_LT((stack.world.bodyState(0).X_WB.translation() - stack.world.bodySpec(0).X_WB.translation()).norm(), 1e-6);
  EXPECT_LT(stack.speed(), 1e-9);
}

TEST(Stacks, ThreeCubesDroppedStand) { expectStands(3, 0, 10000); }
TEST(Stacks, TenCubesDroppedStand) { expectStands(10, 0, 10000); }
TEST(Stacks, TenCubesWithOffsetsStand) { expectStands(10, 1e-3, 10000); }

TEST(Stacks, ContactForcesCarryTheWeight) {
  Stack stack(3, 0);
  SolveResult result;
  for (int i = 0; i < 1000; ++i) result = stack.step();
  ASSERT_EQ(stack.contacts.size(), 12u);
  double ground = 0, second = 0;
  for (std::size_t i = 0; i < 12; ++i) (stack.contacts[i].body_b == WORLD_BODY ? ground : second) += result.contact_forces[i].z();
  EXPECT_NEAR(ground, 3 * 9.81, 1e-6);
  EXPECT_NEAR(second, 3 * 9.81, 1e-6);  // 2 g on the first cube, 1 g on the second
}

// Contacts of A with the world and of the world with A are the same thing.
TEST(Stacks, ContactSeenFromTheOtherSide) {
  for (const bool reversed : {false, true}) {
    World world(GRAVITY, {});
    const int cube = world.addBody(boxBody("cube", 1, CUBE, {0, 0, 0.05}));
    BodyState moving = world.bodyState(cube);
    moving.v_WCom = {0.5, 0.2, 0};
    world.setBodyState(cube, moving);
    std::vector<ContactConstraint> contacts;
    SolveResult result;
    for (int i = 0; i < 50; ++i) {
      contacts.clear();
      boxOnPlane(world, cube, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
      if (reversed)
        for (ContactConstraint& c : contacts) std::swap(c.body_a, c.body_b), c.normal_BA = -c.normal_BA;
      result = world.step(1e-3, contacts, {});
    }
    Vector3 sum = Vector3::Zero();
    for (const Vector3& f : result.contact_forces) sum += f;
    const Vector3 slip = Vector3(0.5, 0.2, 0).normalized();
    EXPECT_NEAR((sum * (reversed ? -1 : 1) - (Vector3(0, 0, 9.81) - 0.5 * 9.81 * slip)).norm(), 0, 1e-3) << reversed;
  }
}

TEST(Stacks, HundredKilogramsOnOne) {
  World world(GRAVITY, {});
  const Vector3 big(0.1, 0.1, 0.1);
  const int light = world.addBody(boxBody("light", 1, CUBE, {0, 0, 0.05}));
  const int heavy = world.addBody(boxBody("heavy", 100, big, {0, 0, 0.15 + 0.34}));
  std::vector<ContactConstraint> contacts;
  for (int i = 0; i < 4000; ++i) {
    contacts.clear();
    boxOnPlane(world, light, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
    boxOnBox(world, heavy, big, light, CUBE, {}, &contacts);
    world.step(1e-3, contacts, {});
  }
  EXPECT_NEAR(world.bodyState(heavy).X_WB.translation().z(), 0.15, 1e-4);
  EXPECT_LT(world.bodyState(light).X_WB.translation().head<2>().norm(), 1e-4);
  EXPECT_LT(world.bodyState(heavy).v_WCom.norm(), 1e-6);
}

// Thrown cubes come to rest; no step that is not driven gains energy.
TEST(Stacks, TumblingCubesComeToRestWithoutGainingEnergy) {
  World world(GRAVITY, {});
  for (int i = 0; i < 6; ++i) {
    const int body = world.addBody(boxBody("cube", 1, CUBE, {0.5 * i, 0, 0.3}));
    BodyState state = world.bodyState(body);
    state.X_WB.linear() = makePose(Vector3::Zero(), {0.7 * i, 1.1 * i + 0.2, 0.4 * i}).linear();
    state.w_WB = {9.0 - 3 * i, 2.0 * i, -4};
    state.v_WCom = {0.3 * i, -0.5, 1};
    world.setBodyState(body, state);
  }
  double energy = world.kineticEnergy() + world.potentialEnergy(), most_gained = 0, deepest = 0;
  std::vector<ContactConstraint> contacts;
  for (int step = 0; step < 4000; ++step) {
    contacts.clear();
    for (int b = 0; b < world.bodyCount(); ++b) boxOnPlane(world, b, CUBE, Vector3::UnitZ(), 0, {}, &contacts, 5e-3);
    for (const ContactConstraint& c : contacts) deepest = std::max(deepest, c.depth);
    world.step(1e-3, contacts, {});
    const double now = world.kineticEnergy() + world.potentialEnergy();
    most_gained = std::max(most_gained, now - energy);
    energy = now;
  }
  EXPECT_LT(most_gained, 1e-6);
  EXPECT_LT(deepest, 1e-4);
  for (int b = 0; b < world.bodyCount(); ++b) EXPECT_LT(world.bodyState(b).v_WCom.norm(), 1e-9);
}

/** A plank on the plane that carries forty cubes, each let fall from a height of its own: one island, as large as heaps that may stop. */
struct LadenPlank {
  LadenPlank(const Vector3& gravity, double friction, double drop) : world(gravity, {}) {
    surface.friction = friction;
    world.addBody(boxBody("plank", 10, PLANK, {0, 0, 0.05}));
    for (int i = 0; i < CUBES; ++i)
      world.addBody(boxBody("cube", 1, CUBE, {0.2 * (i % 10 - 4.5), 0.2 * (i / 10 - 1.5), 0.15 + drop * (i % 7) / 6}));
  }

  const SolveResult& step() {
    contacts.clear();
    boxOnPlane(world, 0, PLANK, Vector3::UnitZ(), 0, surface, &contacts);
    for (int i = 1; i <= CUBES; ++i) boxOnBox(world, i, CUBE, 0, PLANK, {}, &contacts);
    return world.step(1e-3, contacts, {});
  }
  double speed() const {
    double worst = 0;
    for (int i = 0; i < world.bodyCount(); ++i) worst = std::max({worst, world.bodyState(i).v_WCom.norm(), world.bodyState(i).w_WB.norm()});
    return worst;
  }

  static constexpr int CUBES = 40;
  const Vector3 PLANK{2, 0.8, 0.1};
  World world;
  Surface surface;
  std::vector<ContactConstraint> contacts;
};

// It stops: no speed is left, not even one of rounding, and its last forces bear it.
TEST(Stacks, ALadenPlankComesToRestWhole) {
  LadenPlank plank(GRAVITY, 0.5, 0.01);
  for (int i = 0; i < 1000; ++i) plank.step();
  for (int i = 0; i < 100; ++i) {
    const SolveResult& result = plank.step();
    ASSERT_EQ(plank.speed(), 0) << i;
    double ground = 0;
    for (std::size_t c = 0; c < plank.contacts.size(); ++c)
      if (plank.contacts[c].body_b == WORLD_BODY) ground += result.contact_forces[c].z();
    ASSERT_NEAR(ground, 50 * G, 1e-4);
  }
}

// What hardly moves, but is driven, goes on: on a slope of 1e-5 without friction.
TEST(Stacks, ALadenPlankStartsOnTheFaintestSlope) {
  const double slope = 1e-5;
  LadenPlank plank(Vector3(slope * G, 0, -G), 0, 0);
  for (int i = 0; i < 1000; ++i) plank.step();
  for (int i = 0; i < plank.world.bodyCount(); ++i) EXPECT_NEAR(plank.world.bodyState(i).v_WCom.x(), slope * G, 0.01 * slope * G) << i;
}

}  // namespace
}  // namespace blem_sim::dynamics
