// Once warm, a step of the articulated stepper asks the heap for nothing.
#include <gtest/gtest.h>

#include "dynamics/analytic_contacts.h"
#include "dynamics/bouncing_bodies.h"
#include "support/chains.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

#include "support/counted_allocations.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

/** A stack of three, a box that slides beside it, and a motor driven arm with a mimic joint. */
struct BusyWorld {
  BusyWorld() : world({0, 0, -9.81}, {}), drives(2) {
    for (int i = 0; i < 3; ++i) world.addBody(boxBody("cube", 1, CUBE, {0, 0, 0.05 + 0.1 * i}));
    world.addBody(boxBody("slider", 1, CUBE, {1, 0, 0.05}));
    BodyState state = world.bodyState(3);
    state.v_WCom = {3, 0, 0};
    world.setBodyState(3, state);
    JointSpec joint;
    joint.child = world.addBody(boxBody("upper", 0.5, {0.3, 0.02, 0.02}, {0, 2, 1}));
    joint.axis = Vector3::UnitY(), joint.X_PJ = makePose({0, 2, 1});
    world.addJoint(joint);
    joint.parent = joint.child;
    joint.child = world.addBody(boxBody("lower", 0.5, {0.3, 0.02, 0.02}, {0.3, 2, 1}));
    joint.X_PJ = makePose({0.3, 0, 0}), joint.mimic_joint = 0, joint.mimic_multiplier = 0.5;
    world.addJoint(joint);
    drives[0].stiffness = 20, drives[0].damping = 0.5, drives[0].dry_friction = 0.1;
    contacts.reserve(64);
  }
  const SolveResult& step() {
    contacts.clear();
    boxOnPlane(world, 0, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
    boxOnBox(world, 1, CUBE, 0, CUBE, {}, &contacts);
    boxOnBox(world, 2, CUBE, 1, CUBE, {}, &contacts);
    boxOnPlane(world, 3, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
    drives[0].target_position = 0.3 * std::sin(1e-2 * steps++);
    const long before = allocations;
    const SolveResult& result = world.step(1e-3, contacts, drives);
    allocated += allocations - before;
    return result;
  }
  World world;
  std::vector<JointDrive> drives;
  std::vector<ContactConstraint> contacts;
  int steps = 0;
  long allocated = 0;
};

TEST(Allocation, NoneWhereFastTreesAreFollowed) {
  Chain chain(taper(6, {1, 0.3}, {0.02, 0.05}));
  Spinner spinner(1, 100);
  long before = 0;
  for (int i = 0; i < 1000; ++i) {
    if (i == 200) before = allocations;
    chain.step(1e-3);
    spinner.world.step(1e-3, {}, {});
  }
  EXPECT_EQ(allocations, before);
}

// A row of balls between walls, and a pendulum that they hit.
TEST(Allocation, NoneInAWarmStepOfBounces) {
  Surface surface;
  surface.restitution = 1, surface.friction = 0;
  BouncingBodies scene(Vector3::Zero(), surface);
  scene.walls = {{Vector3::UnitX(), -0.5}, {-Vector3::UnitX(), -0.5}};
  for (int i = 0; i < 6; ++i) scene.addSphere(1 + i, 0.03, {-0.4 + 0.1 * i, 0.001 * i, 0});
  scene.setVelocity(0, {2, 0, 0}, Vector3::Zero());
  scene.addSphere(1, 0.03, {0.3, 0, 0});
  scene.hinge(WORLD_BODY, 6, {0.3, 0, 0.4}, Vector3::UnitY());
  const std::vector<JointDrive> drives(1);
  long allocated = 0, impacts = 0;
  for (int i = 0; i < 4000; ++i) {
    scene.findContacts(1e-3);
    const long before = allocations;
    const SolveResult& result = scene.world.step(1e-3, scene.contacts, drives);
    if (i < 1000) continue;
    allocated += allocations - before;
    for (const Vector3& force : result.contact_forces) impacts += !force.isZero(0);
  }
  EXPECT_GT(impacts, 5);
  EXPECT_EQ(allocated, 0);
}

// Many bodies are swept: a tower that is kicked again and again.
TEST(Allocation, NoneInAWarmStepOfAHeap) {
  constexpr int CUBES = 40;
  World world({0, 0, -9.81}, {});
  for (int i = 0; i < CUBES; ++i) world.addBody(boxBody("cube", 1, CUBE, {0, 0, 0.05 + 0.1 * i}));
  std::vector<ContactConstraint> contacts;
  contacts.reserve(8 * CUBES);
  long allocated = 0, iterations = 0;
  for (int k = 0; k < 60; ++k) {
    contacts.clear();
    boxOnPlane(world, 0, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
    for (int i = 1; i < CUBES; ++i) boxOnBox(world, i, CUBE, i - 1, CUBE, {}, &contacts);
    for (int i = 0; k % 20 == 0 && i < CUBES; ++i)
      world.applyWrench(i, {{i % 2 ? 30.0 : -30.0, 0, 0}, Vector3::Zero()}, world.bodyState(i).X_WB.translation());
    const long before = allocations;
    const SolveResult& result = world.step(1e-3, contacts, {});
    if (k < 40) continue;
    allocated += allocations - before;
    iterations += result.iterations;
  }
  EXPECT_GT(iterations, 60);
  EXPECT_EQ(allocated, 0);
}

TEST(Allocation, NoneInAWarmStep) {
  BusyWorld busy;
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(busy.step().finite);
  EXPECT_GT(busy.allocated, 0);
  busy.allocated = 0;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(busy.step().finite);
  EXPECT_EQ(busy.allocated, 0);
}

}  // namespace
}  // namespace blem_sim::dynamics

#endif
