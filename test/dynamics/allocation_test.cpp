// Once warm, a step of the articulated stepper asks the heap for nothing.
#include <gtest/gtest.h>

#include "analytic_contacts.h"
#include "support/chains.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

#include "support/counted_allocations.h"

namespace blem_sim {
namespace {

const Vector3 CUBE(0.1, 0.1, 0.1);

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

TEST(Allocation, NoneInAWarmStep) {
  BusyWorld busy;
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(busy.step().finite);
  EXPECT_GT(busy.allocated, 0);
  busy.allocated = 0;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(busy.step().finite);
  EXPECT_EQ(busy.allocated, 0);
}

}  // namespace
}  // namespace blem_sim

#endif
