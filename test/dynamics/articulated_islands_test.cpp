// The articulated stepper where trees meet: loops, threads, edits from outside; and its report of its own solve.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/shortest_turn.h"
#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

int addBar(World* world, const Vector3& from, const Vector3& to) {
  BodySpec bar = boxBody("bar", 0.4, {0.02, 0.02, (to - from).norm()}, Vector3::Zero());
  bar.X_WB.translation() = from;
  bar.X_WB.linear() = geometry::shortestTurn(Vector3::UnitZ(), to - from).toRotationMatrix();
  bar.inertial.com = {0, 0, 0.5 * (to - from).norm()};
  return world->addBody(bar);
}

/** Joins a child to a parent at a point of the world, about y. */
int addHinge(World* world, int parent, int child, const Vector3& point, JointKind kind = JointKind::REVOLUTE) {
  JointSpec spec;
  spec.kind = kind;
  spec.parent = parent;
  spec.child = child;
  const Pose X_WP = parent == WORLD_BODY ? Pose::Identity() : world->bodyState(parent).X_WB;
  spec.X_PJ = X_WP.inverse() * makePose(point);
  spec.axis = spec.X_PJ.linear() * Vector3::UnitY();
  return world->addJoint(spec);
}

/** Crank, coupler and rocker between two pins of the world; the last hinge closes the loop. */
struct FourBar {
  FourBar() : world({0, 0, -G}, {}), drives(4) {
    const Vector3 crank_end(0, 0, 0.1), rocker_end(0.35, 0, 0.25), foot(0.3, 0, 0);
    crank = addBar(&world, Vector3::Zero(), crank_end);
    coupler = addBar(&world, crank_end, rocker_end);
    rocker = addBar(&world, foot, rocker_end);
    addHinge(&world, WORLD_BODY, crank, Vector3::Zero());
    addHinge(&world, crank, coupler, crank_end);
    addHinge(&world, WORLD_BODY, rocker, foot);
    closing = addHinge(&world, rocker, coupler, rocker_end);
  }
  double gap() const {
    const Vector3 on_coupler = world.bodyState(coupler).X_WB * Vector3(0, 0, Vector3(0.35, 0, 0.15).norm());
    return (on_coupler - world.bodyState(rocker).X_WB * Vector3(0, 0, Vector3(0.05, 0, 0.25).norm())).norm();
  }
  World world;
  std::vector<JointDrive> drives;
  int crank, coupler, rocker, closing;
};

TEST(ArticulatedLoop, StaysClosedWhileItsCrankTurns) {
  FourBar bar;
  bar.drives[0].damping = 100;
  bar.drives[0].target_velocity = 3;
  for (int i = 0; i < 3000; ++i) {
    const SolveResult& result = bar.world.step(DT, {}, bar.drives);
    ASSERT_TRUE(result.finite);
    ASSERT_LT(result.creep, 1e-6) << i;
    ASSERT_LT(bar.gap(), 1e-6) << i;
  }
  EXPECT_NEAR(bar.world.jointState(0).velocity, 3, 0.3);
}

// The bar swings fast enough for the bend of the paths to matter.
TEST(ArticulatedLoop, StaysClosedWhileItSwingsFreely) {
  FourBar bar;
  double fastest = 0;
  for (int i = 0; i < 3000; ++i) {
    ASSERT_TRUE(bar.world.step(DT, {}, bar.drives).finite);
    ASSERT_LT(bar.gap(), 1e-6) << i;
    fastest = std::max(fastest, std::abs(bar.world.jointState(0).velocity));
  }
  EXPECT_GT(fastest, 5);
}

// The two pins of the world carry all of a bar that is held still; the closing joint's wrench is part of the balance.
TEST(ArticulatedLoop, CarriesItsWeight) {
  FourBar bar;
  bar.drives[0].stiffness = 1e4, bar.drives[0].damping = 100;
  SolveResult result;
  for (int i = 0; i < 3000; ++i) result = bar.world.step(DT, {}, bar.drives);
  EXPECT_NEAR(result.joint_wrenches[0].force.z() + result.joint_wrenches[2].force.z(), 3 * 0.4 * G, 1e-8);
  EXPECT_NEAR(result.joint_wrenches[1].force.z() + result.joint_wrenches[bar.closing].force.z(), 0.4 * G, 1e-8);
  EXPECT_GT(result.joint_wrenches[bar.closing].force.norm(), 0.1);
}

double largestForce(const SolveResult& result) {
  double largest = 0;
  for (const Vector3& force : result.contact_forces) largest = std::max(largest, force.norm());
  return largest;
}

TEST(ArticulatedThreads, AnyNumberGivesTheSameBits) {
  const auto run = [](int threads) {
    SolverSettings settings;
    settings.threads = threads;
    World world({0, 0, -G}, settings);
    for (int i = 0; i < 12; ++i) world.addBody(boxBody("cube", 1 + i, CUBE, {0.5 * (i / 2), 0.002 * i, 0.1 + 0.15 * (i % 2)}));
    for (int k = 0; k < 300; ++k) {
      std::vector<ContactConstraint> contacts;
      for (int i = 0; i < 12; i += 2) {
        boxOnPlane(world, i, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
        boxOnBox(world, i + 1, CUBE, i, CUBE, {}, &contacts);
      }
      world.step(DT, contacts, {});
    }
    return world.save();
  };
  const WorldState one = run(1);
  EXPECT_EQ(run(2), one);
  EXPECT_EQ(run(4), one);
}

/** Gears in a wall, each turning against its neighbours and rubbing on them: one island, which is swept in regions. */
struct Gears {
  static constexpr int COLUMNS = 30, ROWS = 10;
  static constexpr double RADIUS = 0.1;

  explicit Gears(int threads) : world(Vector3::Zero(), settingsOf(threads)) {
    for (int i = 0; i < COLUMNS * ROWS; ++i) {
      world.addBody(boxBody("gear", 1, Vector3::Constant(RADIUS), {2 * RADIUS * (i % COLUMNS), 0, 2 * RADIUS * (i / COLUMNS)}));
      BodyState state = world.bodyState(i);
      state.w_WB = {0, (i % COLUMNS + i / COLUMNS) % 2 ? 1.0 : 1.5, 0};
      state.v_WCom = {i % COLUMNS < COLUMNS / 2 ? 0.5 : -0.5, 0, 0};
      world.setBodyState(i, state);
      if (i % COLUMNS > 0) touch(i, i - 1, Vector3::UnitX());
      if (i >= COLUMNS) touch(i, i - COLUMNS, Vector3::UnitZ());
    }
  }
  static SolverSettings settingsOf(int threads) {
    SolverSettings settings;
    settings.threads = threads;
    return settings;
  }
  void touch(int a, int b, const Vector3& normal) {
    ContactConstraint c;
    c.body_a = a;
    c.body_b = b;
    c.normal_BA = normal;
    c.point = world.bodyState(a).X_WB.translation() - RADIUS * normal;
    c.friction = 0.5;
    c.id = contacts.size();
    contacts.push_back(c);
  }
  Vector3 momentum() const {
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < COLUMNS * ROWS; ++i) sum += world.bodyState(i).v_WCom;
    return sum;
  }

  World world;
  std::vector<ContactConstraint> contacts;
};

TEST(ArticulatedThreads, RegionsOfALargeIslandAreSweptToTheSameBits) {
  const auto run = [](int threads) {
    Gears gears(threads);
    const double before = gears.world.kineticEnergy();
    for (int i = 0; i < 3; ++i) {
      const SolveResult& result = gears.world.step(DT, gears.contacts, {});
      EXPECT_TRUE(result.finite);
      EXPECT_LT(result.residual, 0.01 * largestForce(result)) << "of Coulomb's law, step " << i;
    }
    EXPECT_LT(gears.momentum().norm(), 1e-10);
    EXPECT_LT(gears.world.kineticEnergy(), 0.7 * before);
    return gears.world.save();
  };
  const WorldState one = run(1);
  EXPECT_EQ(run(2), one);
  EXPECT_EQ(run(3), one);
}

// A rotor's inertia adds to the link's: the same effort turns the joint more slowly, and the same gravity too.
TEST(ArticulatedJoint, ArmatureAddsToTheInertia) {
  const auto speed = [](double armature) {
    World world(Vector3::Zero(), {});
    JointSpec spec;
    spec.child = world.addBody(boxBody("wheel", 1, CUBE, Vector3::Zero()));
    spec.axis = Vector3::UnitY();
    spec.armature = armature;
    world.addJoint(spec);
    std::vector<JointDrive> drives(1);
    drives[0].effort = 0.5;
    for (int i = 0; i < 100; ++i) world.step(DT, {}, drives);
    return world.jointState(0).velocity;
  };
  const double inertia = 0.02 / 12;
  EXPECT_NEAR(speed(0), 0.05 / inertia, 1e-9);
  EXPECT_NEAR(speed(3 * inertia), 0.05 / (4 * inertia), 1e-9);
}

// The upper link is set from outside: its tree is read back, and only its tree.
TEST(ArticulatedEdits, AreReadBackOnce) {
  World world({0, 0, -G}, {});
  const int flying = world.addBody(boxBody("flying", 1, CUBE, {0, 0, 5})), other = world.addBody(boxBody("other", 1, CUBE, {1, 0, 5}));
  for (int i = 0; i < 50; ++i) world.step(DT, {}, {});
  const BodyState before = world.bodyState(other);
  BodyState state = world.bodyState(flying);
  state.X_WB.translation() = Vector3(0, 0, 9);
  state.v_WCom = {1, 0, 0};
  state.w_WB = {0, 0, 2};
  world.setBodyState(flying, state);
  for (int i = 0; i < 100; ++i) world.step(DT, {}, {});
  const BodyState after = world.bodyState(flying);
  EXPECT_NEAR(after.X_WB.translation().x(), 0.1, 1e-12);
  EXPECT_NEAR(after.X_WB.translation().z(), 9 - 0.5 * G * 0.1 * 0.101, 1e-12);
  EXPECT_NEAR(after.w_WB.z(), 2, 1e-12);
  EXPECT_NEAR(world.bodyState(other).v_WCom.z(), before.v_WCom.z() - 0.1 * G, 1e-12);
}

// Legs that swing in flight: the whole goes on along its parabola, and turns no more than its momentum says.
TEST(ArticulatedFlight, KeepsItsMomenta) {
  World world({0, 0, -G}, {});
  const int torso = world.addBody(boxBody("torso", 5, {0.2, 0.3, 0.4}, Vector3::Zero()));
  std::vector<JointDrive> drives;
  for (const double side : {-1.0, 1.0}) {
    const int leg = world.addBody(boxBody("leg", 2, {0.08, 0.08, 0.4}, {0, 0.1 * side, -0.4}));
    addHinge(&world, torso, leg, {0, 0.1 * side, -0.2});
    drives.push_back({});
    drives.back().stiffness = 200, drives.back().damping = 5;
  }
  const auto com = [&] {
    Vector3 sum = Vector3::Zero();
    for (int b = 0; b < 3; ++b) sum += world.bodySpec(b).inertial.mass * world.bodyState(b).X_WB.translation();
    return Vector3(sum / 9);
  };
  const Vector3 start = com();
  for (int i = 0; i < 1000; ++i) {
    drives[0].target_position = 0.8 * std::sin(6 * i * DT), drives[0].target_velocity = 4.8 * std::cos(6 * i * DT);
    drives[1].target_position = 0.3 * drives[0].target_position;
    world.step(DT, {}, drives);
  }
  EXPECT_LT((com() - start + Vector3(0, 0, 0.5 * G * 1.001)).norm(), 1e-7);
}

// A step that is like the one before is exact; the report states the residual.
TEST(ArticulatedReport, StatesWhatIsLeft) {
  World world({0, 0, -G}, {});
  world.addBody(boxBody("cube", 1, CUBE, {0, 0, 0.0501}));
  int most = 0;
  SolveResult result;
  for (int i = 0; i < 200; ++i) {
    std::vector<ContactConstraint> contacts;
    boxOnPlane(world, 0, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
    result = world.step(DT, contacts, {});
    most = std::max(most, result.iterations);
    ASSERT_LT(result.residual, 1e-4) << i;
  }
  EXPECT_GT(most, 0);
  EXPECT_LE(result.iterations, 1);
  EXPECT_LT(result.residual, 1e-9);
}

}  // namespace
}  // namespace blem_sim::dynamics
