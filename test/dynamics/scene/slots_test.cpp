// Indices of removed bodies and joints are given out again, and nothing is left of their earlier owners.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "blem_sim/geometry/input_error.h"
#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

class Slots : public testing::TestWithParam<const char*> {
 protected:
  Slots() : world({0, 0, -9.81}, settings()) {}
  static SolverSettings settings() {
    SolverSettings settings;
    settings.stepper = GetParam();
    return settings;
  }
  /** `quick_step` shuffles its rows by a seed that is its world's own. */
  static double tolerance() { return std::string(GetParam()) == "quick_step" ? 1e-5 : 1e-12; }
  int addBox(double x) { return world.addBody(boxBody("box", 1, CUBE, {x, 0, 1})); }
  int addHinge(int child, int mimic = -1) {
    JointSpec spec;
    spec.name = "hinge";
    spec.child = child;
    spec.axis = Vector3::UnitY();
    spec.X_PJ = makePose({world.bodyState(child).X_WB.translation().x() + 0.2, 0, 1});
    spec.mimic_joint = mimic;
    return world.addJoint(spec);
  }
  void step(int steps, double dry_friction = 0) {
    std::vector<JointDrive> drives(world.jointCount());
    for (JointDrive& drive : drives) drive.dry_friction = dry_friction;
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(world.step(DT, {}, drives).finite);
  }

  World world;
};

TEST_P(Slots, TheLowestFreeOneIsTakenHoweverOften) {
  for (int i = 0; i < 4; ++i) addHinge(addBox(i));
  for (int i = 0; i < 1000; ++i) {
    const int first = i % 4, second = (i + 2) % 4;
    world.removeBody(first);
    world.removeBody(second);
    EXPECT_EQ(addBox(first), std::min(first, second));
    EXPECT_EQ(addBox(second), std::max(first, second));
    EXPECT_EQ(addHinge(second), std::min(first, second));
    EXPECT_EQ(addHinge(first), std::max(first, second));
    step(1);
  }
  EXPECT_EQ(world.bodyCount(), 4);
  EXPECT_EQ(world.jointCount(), 4);
}

// Joints that went were looked up among the fewer dofs that are left, beyond their end: the address sanitizer sees it.
TEST_P(Slots, JointsThatWentAreNotAskedForAnyMore) {
  const int first = addHinge(addBox(0));
  for (int i = 1; i < 9; ++i) addHinge(addBox(i), first);
  step(2);
  for (int body = 8; body >= 2; --body) world.removeBody(body);
  step(2);
  EXPECT_NEAR(world.jointState(0).position, world.jointState(1).position, tolerance());
}

/** A joint that stuck by friction leaves nothing to the next one in its slot. */
TEST_P(Slots, AJointBeginsWithoutMemory) {
  addHinge(addBox(0));
  step(100, 100);
  world.removeBody(0);
  addHinge(addBox(0));
  World fresh({0, 0, -9.81}, settings());
  fresh.addBody(world.bodySpec(0));
  fresh.addJoint(world.jointSpec(0));
  EXPECT_EQ(world.save().numbers, fresh.save().numbers);
  step(50, 1);
  std::vector<JointDrive> drives(1);
  drives[0].dry_friction = 1;
  for (int i = 0; i < 50; ++i) fresh.step(DT, {}, drives);
  EXPECT_NEAR(world.jointState(0).position, fresh.jointState(0).position, tolerance());
}

TEST_P(Slots, WhatMimicsARemovedJointIsFreeOfTheNext) {
  const int master = addHinge(addBox(0)), mimic = addHinge(addBox(1), master);
  world.removeBody(0);
  EXPECT_THROW(addHinge(1, master), InputError);
  EXPECT_EQ(addHinge(addBox(0)), master);
  EXPECT_EQ(world.jointSpec(mimic).mimic_joint, -1);
  std::vector<JointDrive> drives(2);
  drives[master].dry_friction = 1000;
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(world.step(DT, {}, drives).finite);
  EXPECT_NEAR(world.jointState(master).position, 0, 1e-3);
  EXPECT_GT(std::abs(world.jointState(mimic).position), 0.01);
}

TEST_P(Slots, ForgottenContactsAreStrangers) {
  World fresh({0, 0, -9.81}, settings());
  for (World* w : {&world, &fresh}) w->addBody(boxBody("box", 1, CUBE, {0, 0, 0.05}));
  Surface bouncy;
  bouncy.restitution = 0.8;
  std::vector<ContactConstraint> contacts;
  boxOnPlane(world, 0, CUBE, Vector3::UnitZ(), 0, bouncy, &contacts);
  BodyState falling = world.bodyState(0);
  // `articulated` remembers no impacts: there the box rests on its contacts.
  falling.v_WCom = {0.5, 0, std::string(GetParam()) == "articulated" ? 0 : -1.0};
  world.setBodyState(0, falling);
  ASSERT_TRUE(world.step(DT, contacts, {}).finite);
  const WorldState met = world.save();
  std::vector<std::uint64_t> ids = {~0ull};
  for (const ContactConstraint& contact : contacts) ids.push_back(contact.id);
  world.forgetContacts(ids);
  EXPECT_FALSE(world.save() == met);
  world.forgetContacts(ids);
  fresh.setBodyState(0, world.bodyState(0));
  for (World* w : {&world, &fresh}) {
    contacts.clear();
    boxOnPlane(*w, 0, CUBE, Vector3::UnitZ(), 0, bouncy, &contacts);
    ASSERT_TRUE(w->step(DT, contacts, {}).finite);
  }
  EXPECT_NEAR((world.bodyState(0).v_WCom - fresh.bodyState(0).v_WCom).norm(), 0, tolerance());
}

TEST_P(Slots, RenamedContactsGoOn) {
  world.addBody(boxBody("box", 1, CUBE, {0, 0, 0.05}));
  std::vector<ContactConstraint> contacts;
  boxOnPlane(world, 0, CUBE, Vector3::UnitZ(), 0, Surface(), &contacts);
  BodyState sliding = world.bodyState(0);
  sliding.v_WCom = {0.5, 0, 0};
  world.setBodyState(0, sliding);
  ASSERT_TRUE(world.step(DT, contacts, {}).finite);
  const WorldState met = world.save();
  std::vector<std::uint64_t> before, after;
  ContactRenames there, back;
  for (const ContactConstraint& contact : contacts) {
    before.push_back(contact.id);
    after.push_back(~contact.id);
    there.push_back({contact.id, ~contact.id, true});
    back.push_back({~contact.id, contact.id, true});
  }
  world.forgetContacts(before, there);
  const WorldState turned = world.save();
  EXPECT_FALSE(turned == met);
  world.forgetContacts(after, back);
  EXPECT_TRUE(world.save() == met);
  for (ContactRename& rename : there) rename.turned = false;
  world.forgetContacts(before, there);
  EXPECT_FALSE(world.save() == turned);
}

INSTANTIATE_TEST_SUITE_P(Steppers, Slots, testing::Values("world_step", "quick_step", "articulated"));

}  // namespace
}  // namespace blem_sim::dynamics
