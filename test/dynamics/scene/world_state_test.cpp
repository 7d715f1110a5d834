// Replay bit for bit, worlds that do not disturb each other, states that are not finite.
#include <gtest/gtest.h>

#include <thread>

#include "blem_sim/geometry/input_error.h"
#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

/** A bouncing box, a stack of two, and a motor driven arm with a mimic joint. */
struct Scene3 {
  explicit Scene3(const std::string& stepper) : world({0, 0, -9.81}, settings(stepper)) {
    Vector3 p(0, 0, 0.3);
    world.addBody(boxBody("bouncing", 1, CUBE, p));
    world.addBody(boxBody("lower", 1, CUBE, {1, 0, 0.05}));
    world.addBody(boxBody("upper", 2, CUBE, {1.001, 0.002, 0.17}));
    BodySpec bar = boxBody("bar", 0.5, {0.3, 0.02, 0.02}, {0, 2, 1});
    bar.inertial.com = {0.15, 0, 0};
    const int first = world.addBody(bar);
    bar.X_WB = makePose({0.3, 2, 1});
    const int second = world.addBody(bar);
    JointSpec joint;
    joint.name = "first", joint.child = first, joint.axis = Vector3::UnitY(), joint.X_PJ = makePose({0, 2, 1});
    world.addJoint(joint);
    joint.name = "second", joint.parent = first, joint.child = second, joint.X_PJ = makePose({0.3, 0, 0});
    joint.mimic_joint = 0, joint.mimic_multiplier = 0.5;
    world.addJoint(joint);
    BodyState state = world.bodyState(0);
    state.X_WB.linear() = makePose(Vector3::Zero(), {0.3, 0.2, 0.1}).linear();
    state.w_WB = {1, 2, 3}, state.v_WCom = {0.5, 0, 0};
    world.setBodyState(0, state);
  }
  static SolverSettings settings(const std::string& stepper) {
    SolverSettings s;
    s.stepper = stepper;
    return s;
  }
  const SolveResult& step() {
    contacts.clear();
    Surface bouncy;
    bouncy.restitution = 0.6;
    boxOnPlane(world, 0, CUBE, Vector3::UnitZ(), 0, bouncy, &contacts);
    boxOnPlane(world, 1, CUBE, Vector3::UnitZ(), 0, {}, &contacts);
    boxOnBox(world, 2, CUBE, 1, CUBE, {}, &contacts);
    std::vector<JointDrive> drives(2);
    drives[0].stiffness = 20, drives[0].damping = 0.5, drives[0].target_position = 0.7, drives[0].dry_friction = 0.1;
    return world.step(DT, contacts, drives);
  }
  World world;
  std::vector<ContactConstraint> contacts;
};

class Replay : public ::testing::TestWithParam<std::string> {};

TEST_P(Replay, RestoredMidImpactRunsTheSame) {
  Scene3 scene(GetParam());
  // Steps until the bouncing box has just landed, its rebound still to come.
  int steps = 0;
  for (bool landed = false; !landed && steps < 400; ++steps) {
    scene.step();
    for (const ContactConstraint& c : scene.contacts) landed |= c.body_a == 0 && c.depth > -2e-4;
  }
  ASSERT_LT(steps, 400);
  scene.world.applyWrench(0, {{1, 2, 3}, {0.1, 0, 0}}, {0, 0, 0.1});
  const WorldState middle = scene.world.save();
  for (int i = 0; i < 300; ++i) scene.step();
  const WorldState end = scene.world.save();
  scene.world.restore(middle);
  EXPECT_EQ(scene.world.save(), middle);
  for (int i = 0; i < 300; ++i) scene.step();
  EXPECT_EQ(scene.world.save(), end);
  Scene3 other(GetParam());
  other.world.restore(middle);
  for (int i = 0; i < 300; ++i) other.step();
  EXPECT_EQ(other.world.save(), end);
  EXPECT_FALSE(middle == end);
}

TEST_P(Replay, InterleavedWorldsKeepTheirBits) {
  Scene3 alone(GetParam());
  for (int i = 0; i < 300; ++i) alone.step();
  Scene3 a(GetParam()), b("quick_step"), c("world_step");
  for (int i = 0; i < 300; ++i) a.step(), b.step(), c.step();
  EXPECT_EQ(a.world.save(), alone.world.save());
}

TEST_P(Replay, WorldsInThreadsKeepTheirBits) {
  Scene3 alone(GetParam());
  for (int i = 0; i < 200; ++i) alone.step();
  Scene3 a(GetParam()), b(GetParam());
  const auto run = [](Scene3* scene) {
    for (int i = 0; i < 200; ++i) scene->step();
  };
  std::thread first(run, &a), second(run, &b);
  first.join(), second.join();
  EXPECT_EQ(a.world.save(), alone.world.save());
  EXPECT_EQ(b.world.save(), alone.world.save());
}

TEST_P(Replay, BrokenStepIsReportedAndTheWorldLivesOn) {
  Scene3 scene(GetParam()), undisturbed(GetParam());
  for (int i = 0; i < 100; ++i) scene.step(), undisturbed.step();
  // The input is not a number.
  scene.contacts = {contactOf(0, WORLD_BODY, {0, 0, std::nan("")}, Vector3::UnitZ(), 0, {}, 1)};
  EXPECT_FALSE(scene.world.step(DT, scene.contacts, std::vector<JointDrive>(2)).finite);
  // The result is not a number: ODE itself fails on it.
  const BodyState sane = scene.world.bodyState(0);
  scene.world.applyWrench(0, {{0, 0, 0}, {1e200, -1e250, 1e290}}, Vector3::Zero());
  EXPECT_FALSE(scene.step().finite);
  EXPECT_EQ(scene.world.bodyState(0).v_WCom, sane.v_WCom);
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(scene.step().finite);
    undisturbed.step();
  }
  EXPECT_EQ(scene.world.save(), undisturbed.world.save());
}

INSTANTIATE_TEST_SUITE_P(Steppers, Replay, ::testing::Values("world_step", "quick_step", "articulated"));

TEST(WorldState, ForeignStateIsRefused) {
  Scene3 scene("world_step");
  World small({0, 0, -9.81}, {});
  small.addBody(boxBody("box", 1, CUBE, Vector3::Zero()));
  EXPECT_THROW(small.restore(scene.world.save()), InputError);
  EXPECT_THROW(small.restore(WorldState()), InputError);
}

TEST(Steppers, TableNamesAll) { EXPECT_EQ(stepperNames(), (std::vector<std::string>{"world_step", "quick_step", "articulated"})); }

}  // namespace
}  // namespace blem_sim::dynamics
