// Free bodies: flight, spin, wrenches from outside.
#include <gtest/gtest.h>

#include <algorithm>

#include "dynamics/analytic_contacts.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

TEST(Motion, FreeFall) {
  World world({0, 0, -9.81}, {});
  const int body = world.addBody(boxBody("box", 2, {0.1, 0.2, 0.3}, {0, 0, 10}));
  for (int i = 0; i < 1000; ++i) world.step(DT, {}, {});
  // Semi-implicit Euler's own sum: h + h g dt n (n + 1) / 2.
  EXPECT_NEAR(world.bodyState(body).X_WB.translation().z(), 10 - 9.81 * DT * DT * 1000 * 1001 / 2, 1e-11);
  EXPECT_NEAR(world.bodyState(body).v_WCom.z(), -9.81, 1e-12);
}

TEST(Motion, ProjectileWithItsCentreOfMassOffTheFrame) {
  World world({0, 0, -9.81}, {});
  BodySpec spec = boxBody("box", 1, {0.1, 0.1, 0.1}, {1, 2, 3});
  spec.inertial.com = {0.3, -0.2, 0.1};
  spec.X_WB = makePose({1, 2, 3}, {0.1, 0.2, 0.3});
  const int body = world.addBody(spec);
  const Vector3 com = spec.X_WB * spec.inertial.com;
  BodyState state = world.bodyState(body);
  EXPECT_TRUE(state.X_WB.isApprox(spec.X_WB, 1e-14));
  state.v_WCom = {2, 1, 4};
  state.w_WB = {0, 0, 2};
  world.setBodyState(body, state);
  for (int i = 0; i < 500; ++i) world.step(DT, {}, {});
  const Vector3 theory = com + Vector3(2, 1, 4) * 0.5 - Vector3::UnitZ() * 9.81 * DT * DT * 500 * 501 / 2;
  EXPECT_NEAR((world.bodyState(body).X_WB * spec.inertial.com - theory).norm(), 0, 1e-11);
}

TEST(Motion, SpinAboutAPrincipalAxisIsExact) {
  World world(Vector3::Zero(), {});
  const int body = world.addBody(boxBody("box", 1, {0.1, 0.2, 0.3}, Vector3::Zero()));
  BodyState state;
  state.w_WB = {0, 0, 10};
  world.setBodyState(body, state);
  for (int i = 0; i < 1000; ++i) world.step(DT, {}, {});
  const Matrix3 theory = Eigen::AngleAxisd(10, Vector3::UnitZ()).toRotationMatrix();
  EXPECT_LT((world.bodyState(body).X_WB.linear() - theory).norm(), 1e-11);
  EXPECT_NEAR(world.kineticEnergy(), 0.5 * 1.0 / 12 * 0.05 * 100, 1e-12);
}

/** A tumbling box: its angular momentum and its energy against those of the start. */
struct Tumbling {
  explicit Tumbling(const std::string& stepper) {
    SolverSettings settings;
    settings.stepper = stepper;
    World world(Vector3::Zero(), settings);
    const int body = world.addBody(boxBody("box", 1, {0.1, 0.2, 0.3}, Vector3::Zero()));
    BodyState state;
    state.w_WB = {1, 5, 0.5};
    world.setBodyState(body, state);
    const auto momentum = [&] {
      const BodyState s = world.bodyState(body);
      const Matrix3 R = s.X_WB.linear();
      return Vector3(R * world.bodySpec(body).inertial.inertia * R.transpose() * s.w_WB);
    };
    const Vector3 before = momentum();
    const double energy = world.kineticEnergy();
    for (int i = 0; i < 2000; ++i) {
      world.step(DT, {}, {});
      momentum_off = std::max(momentum_off, (momentum() - before).norm() / before.norm());
      highest = std::max(highest, world.kineticEnergy() / energy - 1);
      lowest = std::min(lowest, world.kineticEnergy() / energy - 1);
    }
  }
  double momentum_off = 0, highest = 0, lowest = 0;
};

TEST(Motion, TumblingInOdeLosesALittle) {
  const Tumbling tumbling("world_step");
  EXPECT_LT(tumbling.momentum_off, 0.02);
  EXPECT_LE(tumbling.highest, 1e-9);
  EXPECT_GT(tumbling.lowest, -0.03);
}

// Carried momentum: the published velocity swings about it by half a step, and nothing is lost.
TEST(Motion, TumblingInTheArticulatedStepperLosesNothing) {
  const Tumbling tumbling("articulated");
  EXPECT_LT(tumbling.momentum_off, 2e-3);
  EXPECT_LE(tumbling.highest, 1e-5);
  EXPECT_GT(tumbling.lowest, -1e-5);
}

TEST(Motion, OutsideWrenchActsForOneStep) {
  World world(Vector3::Zero(), {});
  const int body = world.addBody(boxBody("box", 2, {0.1, 0.1, 0.1}, {1, 0, 0}));
  world.applyWrench(body, {{0, 4, 0}, {0, 0, 0.5}}, {1.5, 0, 0});
  world.step(DT, {}, {});
  const double inertia = 2.0 / 12 * 0.02;
  EXPECT_NEAR(world.bodyState(body).v_WCom.y(), 2e-3, 1e-15);
  EXPECT_NEAR(world.bodyState(body).w_WB.z(), (0.5 + 0.5 * 4) / inertia * DT, 1e-12);
  const BodyState after = world.bodyState(body);
  world.step(DT, {}, {});
  EXPECT_EQ(world.bodyState(body).v_WCom, after.v_WCom);
}

TEST(Motion, EnergyIsThatOfTheParabola) {
  World world({0, 0, -9.81}, {});
  world.addBody(boxBody("box", 2, {0.1, 0.1, 0.1}, {0, 0, 5}));
  EXPECT_NEAR(world.potentialEnergy(), 2 * 9.81 * 5, 1e-12);
  for (int i = 0; i < 500; ++i) world.step(DT, {}, {});
  EXPECT_NEAR(world.potentialEnergy() + world.kineticEnergy(), 2 * 9.81 * 5, 2 * 9.81 * 9.81 * 0.5 * DT);
}

}  // namespace
}  // namespace blem_sim::dynamics
