// What users do to things that touch: contacts that are gone act no more, and those that stay go on as they were.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "blem_sim/sim/named_parts.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double HOLDS_ANYTHING = std::numeric_limits<double>::infinity(), TICK = 0.001, STOREY = 0.105;  // [m] of cubes with layers

/** Cubes of 1 kg on each other, b0 at the bottom, that have come to rest. */
class ChangesInContact : public ::testing::Test {
 protected:
  static constexpr int CUBES = 4;

  static SimulationConfig stack(int cubes) {
    SimulationConfig config;
    config.environments = {ground(20)};
    for (int i = 0; i < cubes; ++i) config.objects.push_back(box(name(i), Vector3::Constant(0.1), 1, {0, 0, 0.5 * STOREY + STOREY * i}));
    return config;
  }
  static std::string name(int cube) { return "b" + std::to_string(cube); }
  ChangesInContact() : simulator(stack(CUBES), model::UriResolver()) { stepFor(&simulator, 0.5); }

  int bodyNumber(int cube) const { return simulator.models()[simulator.modelIndex(name(cube))].bodies[0]; }
  Vector3 velocity(int cube) const { return bodyOf(simulator, name(cube)).v_WCom; }
  double fastest() const {
    double speed = 0;
    for (const dynamics::BodyState& body : simulator.report().bodies) speed = std::max({speed, body.v_WCom.norm(), body.w_WB.norm()});
    return speed;
  }
  /** Makes steps in which all stays at rest, and the ground bears so many cubes [N]. */
  void expectRest(int steps, double cubes) {
    for (int i = 0; i < steps; ++i) {
      const StepReport& report = simulator.step();
      ASSERT_NEAR(forceOfWorld(report).z(), cubes * G, 1e-5) << i;
      ASSERT_LT(fastest(), 1e-8) << i;
      ASSERT_EQ(report.status & ENERGY_GAINED, 0u) << i;
    }
  }

  Simulator simulator;
};

TEST_F(ChangesInContact, WhatStoodOnADeletedCubeFalls) {
  simulator.removeModel(name(0));
  const double height = bodyOf(simulator, name(1)).X_WB.translation().z();
  simulator.step();
  for (const ContactReport& contact : simulator.report().contacts) EXPECT_LT(contact.force.norm(), 1e-9);
  for (int cube = 1; cube < CUBES; ++cube) EXPECT_NEAR((velocity(cube) - Vector3(0, 0, -G * TICK)).norm(), 0, 1e-11) << cube;
  for (int i = 1; i < 50; ++i) simulator.step();
  EXPECT_NEAR(bodyOf(simulator, name(1)).X_WB.translation().z(), height - 0.5 * G * 0.05 * 0.051, 1e-11);
  stepFor(&simulator, 1);
  expectRest(1, CUBES - 1);
}

TEST_F(ChangesInContact, WhatStoodOnAnUnloadedGroundFalls) {
  simulator.unloadEnvironment("ground");
  simulator.step();
  for (int cube = 0; cube < CUBES; ++cube) EXPECT_NEAR((velocity(cube) - Vector3(0, 0, -G * TICK)).norm(), 0, 1e-9) << cube;
  simulator.resetWorld();
  simulator.loadEnvironment(ground(20));
  stepFor(&simulator, 0.2);
  expectRest(20, CUBES);
}

TEST_F(ChangesInContact, WhatIsLoadedAgainUnderAStackBearsItAsBefore) {
  simulator.unloadEnvironment("ground");
  simulator.loadEnvironment(ground(20));
  expectRest(100, CUBES);
}

TEST_F(ChangesInContact, AMovedCubeIsMissedInTheNextStep) {
  dynamics::BodyState away = bodyOf(simulator, name(1));
  away.X_WB.translation().x() += 1;
  simulator.moveModel(bodyNumber(1), away);
  simulator.step();
  EXPECT_LT(velocity(0).norm(), 1e-8);
  EXPECT_NEAR(velocity(1).z(), -G * TICK, 1e-11);
  for (const int cube : {2, 3}) EXPECT_NEAR(velocity(cube).z(), -G * TICK, 1e-9);
  EXPECT_NEAR(forceOfWorld(simulator.report()).z(), G, 1e-5);
}

TEST_F(ChangesInContact, ACubeThatIsPutWhereItIsBearsAsBefore) {
  for (int i = 0; i < 20; ++i) {
    simulator.moveModel(bodyNumber(1), bodyOf(simulator, name(1)));
    expectRest(1, CUBES);
  }
}

TEST_F(ChangesInContact, GravityGoesTurnsAndComesBack) {
  simulator.setPhysics(Vector3::Zero(), TICK, 1);
  expectRest(200, 0);
  const auto tilt = [&](double degrees) {
    const double angle = degrees * M_PI / 180;
    simulator.setPhysics(G * Vector3(std::sin(angle), 0, -std::cos(angle)), TICK, 1);
    return angle;
  };
  for (int cube = 1; cube < CUBES; ++cube) simulator.removeModel(name(cube));  // a stack would tip
  tilt(26.5);                                                                  // friction 0.5 holds up to 26.57 deg
  stepFor(&simulator, 0.2);
  EXPECT_LT(fastest(), 1e-9);
  const double angle = tilt(30);
  stepFor(&simulator, 0.2);
  EXPECT_NEAR(velocity(0).x() / 0.2, G * (std::sin(angle) - 0.5 * std::cos(angle)), 1e-6);
}

TEST_F(ChangesInContact, TimeStepsChangeNothingAtRest) {
  for (const double time_step : {0.002, 0.0005, 0.01, 0.0001, 0.001}) {
    simulator.setPhysics(simulator.gravity(), time_step, 1);
    expectRest(20, CUBES);
  }
}

TEST_F(ChangesInContact, AHeavierLinkWeighsInTheNextStep) {
  geometry::MassProperties inertial = simulator.linkInertial(bodyNumber(2), -1);
  inertial.mass *= 5;
  inertial.inertia *= 5;
  simulator.setLinkInertial(bodyNumber(2), -1, inertial);
  expectRest(20, CUBES + 4);
}

TEST_F(ChangesInContact, ACubeThatComesIntoAnotherIsPushedOutSlowly) {
  RobotConfig guest;
  guest.name = "guest";
  guest.urdf_xml = exactBall("guest", 0.05, 1).urdf_xml;
  guest.X_WR = makePose({0.01, 0.02, CUBES * STOREY + 0.02});  // 3 cm in the uppermost
  simulator.spawn(guest);
  double speed = 0;
  for (int i = 0; i < 1000; ++i) {
    const StepReport& report = simulator.step();
    for (const dynamics::BodyState& body : report.bodies) speed = std::max(speed, body.v_WCom.norm());
    EXPECT_EQ(report.status & ENERGY_GAINED, 0u);
  }
  EXPECT_NEAR(speed, simulator.config().solver.max_correction_speed, 1e-3);
}

/** A push of 8 N on the first of 1 and 3 kg: 2 m/s^2, and 6 N between them, in 11 steps. */
TEST(PushedPair, MovesAsOneUntilThePushEnds) {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.objects = {box("a", Vector3::Constant(0.1), 1, {0, 0, 0}), box("b", Vector3::Constant(0.1), 3, {STOREY, 0, 0})};
  Simulator simulator(config, model::UriResolver());
  const int pushed = findLink(simulator, "a::link", "test").body;
  simulator.applyLoad({pushed, {Vector3(8, 0, 0), Vector3::Zero()}, Vector3::Zero()}, {0, 0.0105});
  for (int i = 1; i <= 30; ++i) {
    Vector3 between = Vector3::Zero();
    for (const ContactReport& contact : simulator.step().contacts)
      between += contact.body_a == pushed ? Vector3(-contact.force) : contact.force;
    EXPECT_NEAR(between.x(), i <= 11 ? 6 : 0, 5e-4) << i;
    for (const char* model : {"a", "b"}) EXPECT_NEAR(bodyOf(simulator, model).v_WCom.x(), 2 * TICK * std::min(i, 11), 1e-6) << i;
  }
}

TEST_F(ChangesInContact, WeldedNeighboursBearWhatContactsBore) {
  simulator.attach(name(2), findLink(simulator, name(1) + "::link", "test"), HOLDS_ANYTHING, HOLDS_ANYTHING);
  expectRest(20, CUBES);
  EXPECT_NEAR(simulator.attachments().at(0).wrench.force.z(), 2 * G, 1e-5);
  simulator.attach(name(3), findLink(simulator, name(2) + "::link", "test"), HOLDS_ANYTHING, HOLDS_ANYTHING);
  expectRest(20, CUBES);
  EXPECT_NEAR(simulator.attachments().at(0).wrench.force.z(), 2 * G, 1e-5);
  EXPECT_NEAR(simulator.attachments().at(1).wrench.force.z(), G, 1e-5);
  for (const int cube : {2, 3}) simulator.detach(name(cube));
  expectRest(20, CUBES);
}

/** A welded pair that tumbles: what is let go flies on as its point moved. */
TEST(TumblingPair, PartsWithTheMotionThatItHad) {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.objects = {box("a", {0.1, 0.06, 0.03}, 1, {0, 0, 0}), box("b", {0.1, 0.05, 0.1}, 0.5, {0.3, 0.1, 0.05})};
  config.objects[0].angular_velocity = {9, 6, 30};
  config.objects[0].linear_velocity = {1, 2, 3};
  Simulator simulator(config, model::UriResolver());
  simulator.attach("b", findLink(simulator, "a::link", "test"), HOLDS_ANYTHING, HOLDS_ANYTHING);
  const Vector3 momentum = bodyOf(simulator, "a").v_WCom + 0.5 * bodyOf(simulator, "b").v_WCom;
  stepFor(&simulator, 0.3);
  const dynamics::BodyState a = bodyOf(simulator, "a"), b = bodyOf(simulator, "b");
  EXPECT_NEAR((a.v_WCom + 0.5 * b.v_WCom - momentum).norm(), 0, 1e-12);
  EXPECT_NEAR((b.v_WCom - a.v_WCom - a.w_WB.cross(b.X_WB.translation() - a.X_WB.translation())).norm(), 0, 1e-12);
  simulator.detach("b");
  stepFor(&simulator, 0.1);
  const dynamics::BodyState flown = bodyOf(simulator, "b");
  EXPECT_NEAR((flown.v_WCom - b.v_WCom).norm(), 0, 1e-12);
  EXPECT_NEAR((flown.X_WB.translation() - b.X_WB.translation() - 0.1 * b.v_WCom).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace blem_sim::sim
