// Drives of free roots over the ground.
#include <gtest/gtest.h>

#include <vector>

#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

RootDrive towards(double x, double y, double spin) {
  RootDrive drive;
  drive.velocity = {x, y};
  drive.spin = spin;
  drive.max_force = 1e6;
  drive.max_torque = 1e6;
  return drive;
}

TEST(RootDrive, ReachesItsTargetInAStepAndLeavesTheRestAlone) {
  World world({0, 0, -9.81}, {});
  const int body = world.addBody(boxBody("box", 2, {0.1, 0.2, 0.3}, {0, 0, 10}));
  BodyState state = world.bodyState(body);
  state.w_WB = {0.3, 0, 0};
  world.setBodyState(body, state);
  const SolveResult& result = world.step(DT, {}, {}, 0, {towards(0.5, -0.2, 0.7)});
  const BodyState end = world.bodyState(body);
  EXPECT_LT((end.v_WCom - Vector3(0.5, -0.2, -9.81 * DT)).norm(), 1e-5);
  EXPECT_NEAR(end.w_WB.z(), 0.7, 1e-5);
  EXPECT_NEAR(end.w_WB.x(), 0.3, 1e-3);
  ASSERT_EQ(result.root_wrenches.size(), 1u);
  EXPECT_LT((result.root_wrenches[0].force - 2 / DT * Vector3(0.5, -0.2, 0)).norm(), 0.05);
  EXPECT_EQ(result.root_wrenches[0].torque.head<2>().norm(), 0);
}

TEST(RootDrive, GivesNoMoreThanItsBounds) {
  World world(Vector3::Zero(), {});
  const int body = world.addBody(boxBody("box", 2, {0.1, 0.2, 0.3}, {0, 0, 10}));
  RootDrive drive = towards(5, 0, 5);
  drive.max_force = 3;
  drive.max_torque = 0.01;
  for (int i = 0; i < 100; ++i) world.step(DT, {}, {}, 0, {drive});
  EXPECT_NEAR(world.bodyState(body).v_WCom.x(), 3.0 / 2 * 100 * DT, 1e-12);
  EXPECT_NEAR(world.bodyState(body).w_WB.z(), 0.01 / (2.0 / 12 * 0.05) * 100 * DT, 1e-10);
}

TEST(RootDrive, NumbersThatAreNoneBreakTheStep) {
  World world(Vector3::Zero(), {});
  world.addBody(boxBody("box", 2, {0.1, 0.2, 0.3}, {0, 0, 10}));
  EXPECT_TRUE(world.step(DT, {}, {}, 0, {towards(1, 0, 0)}).finite);
  EXPECT_FALSE(world.step(DT, {}, {}, 0, {towards(NAN, 0, 0)}).finite);
}

}  // namespace
}  // namespace blem_sim::dynamics
