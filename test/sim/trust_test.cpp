// Signs that a run may not be trusted: contacts that leave their layers, energy out of nothing.
#include <cmath>
#include <utility>

#include "guard/layer_watch.h"
#include "sim/found_contacts_of.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double TRUST_LAYER = 0.005;  // [m] of two boxes

contact::ContactManifold manifoldOf(int a, int b, double depth, bool pierced = false) {
  contact::ContactManifold manifold;
  manifold.a = a;
  manifold.b = b;
  manifold.layer = TRUST_LAYER;
  manifold.pierced = pierced;
  contact::Contact contact;
  contact.depth = depth;
  contact.pierced = pierced;
  manifold.contacts = {contact};
  return manifold;
}

std::vector<LayerEventReport> lookAt(LayerWatch* watch, const std::vector<contact::ContactManifold>& manifolds, double time,
                                     const std::vector<std::pair<int, int>>& passed = {}) {
  std::vector<LayerEventReport> events;
  watch->look(foundContactsOf(manifolds), passed, time, &events);
  return events;
}

TEST(LayerWatch, TellsEveryChangeOnceInOrderOfPairs) {
  LayerWatch watch;
  EXPECT_TRUE(lookAt(&watch, {manifoldOf(0, 1, TRUST_LAYER), manifoldOf(2, 3, -0.001)}, 0).empty());
  std::vector<LayerEventReport> events = lookAt(&watch, {manifoldOf(0, 1, 0.006), manifoldOf(0, 2, 0.001, true), manifoldOf(2, 3, 0)}, 1);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].collider_b, 1);
  EXPECT_TRUE(events[0].outside && !events[0].pierced);
  EXPECT_DOUBLE_EQ(events[0].of_layer, 1.2);
  EXPECT_EQ(events[0].time, 1);
  EXPECT_EQ(events[1].collider_b, 2);
  EXPECT_TRUE(events[1].outside && events[1].pierced);
  EXPECT_TRUE(lookAt(&watch, {manifoldOf(0, 1, 0.007), manifoldOf(0, 2, 0.008)}, 2).empty());
  // One is inside again, the other is gone.
  events = lookAt(&watch, {manifoldOf(0, 2, 0.004)}, 3);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].collider_b, 1);
  EXPECT_FALSE(events[0].outside);
  EXPECT_EQ(events[0].of_layer, 0);
  EXPECT_EQ(events[1].collider_b, 2);
  EXPECT_FALSE(events[1].outside);
  EXPECT_DOUBLE_EQ(events[1].of_layer, 0.8);
  EXPECT_TRUE(lookAt(&watch, {}, 4).empty());
}

TEST(LayerWatch, TellsWhatPassedThoughNeitherEndIsOutside) {
  LayerWatch watch;
  const std::vector<LayerEventReport> events =
      lookAt(&watch, {manifoldOf(0, 1, 0.006), manifoldOf(2, 3, 0.001)}, 0, {{0, 0}, {0, 1}, {2, 3}});
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].collider_b, 0);
  EXPECT_EQ(events[1].collider_b, 1);
  EXPECT_EQ(events[2].collider_b, 3);
  for (const LayerEventReport& event : events) EXPECT_TRUE(event.outside);
  EXPECT_TRUE(events[0].pierced && !events[1].pierced && events[2].pierced);
  EXPECT_DOUBLE_EQ(events[2].of_layer, 0.2);
  // Pairs that are behind each other count as apart again: three changes.
  EXPECT_EQ(lookAt(&watch, {}, 1).size(), 3u);
}

TEST(LayerWatch, ReadsWhatItWroteAndNothingLess) {
  LayerWatch watch;
  lookAt(&watch, {manifoldOf(0, 1, 0.006), manifoldOf(4, 9, 0.006)}, 0);
  geometry::StateContent saved;
  geometry::StateWriter writer(&saved);
  watch.save(&writer);
  LayerWatch other;
  const std::vector<contact::Collider> colliders(10);
  for (geometry::StateContent cut = saved; !cut.words.empty();) {
    cut.words.pop_back();
    geometry::StateReader reader(cut);
    EXPECT_THROW(other.restore(colliders, &reader), InputError) << cut.words.size();
  }
  geometry::StateReader reader(saved);
  other.restore(colliders, &reader);
  EXPECT_EQ(reader.wordsLeft(), 0u);
  EXPECT_EQ(lookAt(&other, {}, 1).size(), 2u);
}

/** A cube that starts 1 mm inside a block: it comes out by itself. */
SimulationConfig cubeInBlock() {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("block", {0.4, 0.4, 0.2}, 50, {0, 0, 0.1025}),
                    box("cube", Vector3::Constant(0.1), 1, {0.05, 0.03, 0.2025 + 0.05 - 0.001})};
  return config;
}

std::vector<LayerEventReport> eventsOf(Simulator* simulator, double seconds) {
  std::vector<LayerEventReport> events;
  const long steps = std::lround(seconds / simulator->config().time_step);
  for (long i = 0; i < steps; ++i) {
    const StepReport& report = simulator->step();
    events.insert(events.end(), report.layer_events.begin(), report.layer_events.end());
  }
  return events;
}

double gainedBy(Simulator* simulator, double seconds) {
  double gained = 0;
  const long steps = std::lround(seconds / simulator->config().time_step);
  for (long i = 0; i < steps; ++i) gained += simulator->step().energy_gained;
  return gained;
}

TEST(LayerEvents, ACubeStartedInABlockIsOutsideOnceAndComesBackOnce) {
  Simulator simulator(cubeInBlock(), model::UriResolver());
  const std::vector<LayerEventReport> events = eventsOf(&simulator, 0.5);
  ASSERT_EQ(events.size(), 2u);
  for (const LayerEventReport& event : events) {
    EXPECT_EQ(simulator.colliders()[event.collider_a].name, "block");
    EXPECT_EQ(simulator.colliders()[event.collider_b].name, "cube");
  }
  EXPECT_TRUE(events[0].outside);
  EXPECT_EQ(events[0].time, 0);
  EXPECT_NEAR(events[0].of_layer, 1.2, 1e-6);
  EXPECT_NEAR(events[0].depth, 0.006, 1e-8);
  EXPECT_TRUE(events[0].pierced);
  EXPECT_FALSE(events[1].outside);
  EXPECT_GT(events[1].time, 0.005);
  EXPECT_LE(events[1].of_layer, 1);
  EXPECT_GT(events[1].of_layer, 0.9);
}

TEST(LayerEvents, NoneInASoundScene) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.1})};
  Simulator simulator(config, model::UriResolver());
  EXPECT_TRUE(eventsOf(&simulator, 0.5).empty());
}

TEST(LayerEvents, ARestoredRunNeitherRepeatsNorLosesThem) {
  Simulator simulator(cubeInBlock(), model::UriResolver());
  EXPECT_EQ(eventsOf(&simulator, 0.005).size(), 1u);
  const SimulationState saved = simulator.save();
  const std::vector<LayerEventReport> first = eventsOf(&simulator, 0.1);
  Simulator other(cubeInBlock(), model::UriResolver());
  other.restore(saved);
  EXPECT_TRUE(other.report().layer_events.empty());
  const std::vector<LayerEventReport> again = eventsOf(&other, 0.1);
  ASSERT_EQ(first.size(), 1u);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_FALSE(again[0].outside);
  EXPECT_EQ(again[0].time, first[0].time);
  other.resetSimulation();
  EXPECT_EQ(eventsOf(&other, 0.005).size(), 1u);
}

TEST(LayerEvents, WhatIsUnloadedIsOutsideNoMore) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.049})};
  Simulator simulator(config, model::UriResolver());
  EXPECT_EQ(eventsOf(&simulator, 0.002).size(), 1u);
  simulator.unloadEnvironment("ground");
  const std::vector<LayerEventReport> events = eventsOf(&simulator, 0.002);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_FALSE(events[0].outside);
  EXPECT_EQ(events[0].depth, 0);
}

TEST(EnergyGained, NothingByAStackAtRest) {
  SimulationConfig config;
  config.environments = {ground()};
  for (int i = 0; i < 3; ++i)
    config.objects.push_back(box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0, 0, 0.0525 + 0.105 * i}));
  Simulator simulator(config, model::UriResolver());
  gainedBy(&simulator, 0.5);
  EXPECT_LT(gainedBy(&simulator, 1), 1e-9);
}

TEST(EnergyGained, LiftedOutOfABlockByAtLeastItsWeight) {
  Simulator simulator(cubeInBlock(), model::UriResolver());
  const double height = bodyOf(simulator, "cube").X_WB.translation().z();
  const double gained = gainedBy(&simulator, 0.5);
  const double rise = bodyOf(simulator, "cube").X_WB.translation().z() - height;
  EXPECT_GT(gained, G * rise);
  EXPECT_LT(gained, G * rise + 0.01);
}

SimulationConfig droppedCube() {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.0525 + 0.2})};
  return config;
}

TEST(EnergyGained, ABounceGivesBackWhatTheImpactTook) {
  SimulationConfig config = droppedCube();
  config.objects[0].contact.restitution = 1;
  Simulator simulator(config, model::UriResolver());
  const double gained = gainedBy(&simulator, 2);
  EXPECT_GT(simulator.report().energy, 0.8 * (G * 0.25));
  EXPECT_LT(gained, 1e-9);
}

TEST(EnergyGained, SpringsGiveBackWhatTheyTook) {
  SimulationConfig config = droppedCube();
  for (ContactOverrides* contact : {&config.environments[0].contact, &config.objects[0].contact}) {
    contact->stiffness = 1e6;
    contact->damping = 1;
  }
  Simulator simulator(config, model::UriResolver());
  EXPECT_LT(gainedBy(&simulator, 2), 1e-3);
}

TEST(EnergyGained, MotorsAndJointFrictionAreAccountedFor) {
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    SimulationConfig config;
    config.robots = {robot("pendulum", pendulumUrdf(R"(<dynamics damping="0.1" friction="0.5"/>)"), true)};
    config.robots[0].motor["default"] = law;
    config.robots[0].gains["default"] = {100, 0, 5, 50};
    Simulator simulator(config, model::UriResolver());
    simulator.commandJoints(0, {{"hinge"}, {-1}, {}, {}});
    const double gained = gainedBy(&simulator, 1);
    EXPECT_GT(simulator.report().energy, 2 * G * 1.3);  // it was lifted
    EXPECT_LT(gained, 1e-3);
  }
}

TEST(EnergyGained, IsTheSameInARestoredRun) {
  SimulationConfig config = droppedCube();
  config.objects[0].contact.restitution = 1;
  Simulator simulator(config, model::UriResolver());
  std::uint64_t hash = 0;
  for (int i = 0; i < 400; ++i) {
    const SimulationState saved = simulator.save();
    const double gained = simulator.step().energy_gained;
    hash = simulator.stateHash();
    simulator.restore(saved);
    EXPECT_EQ(simulator.step().energy_gained, gained) << i;
    EXPECT_EQ(simulator.stateHash(), hash) << i;
  }
}

/** Eight spokes, as a prism of 2 kg, roll down 0.1 rad at 4 rad/s. */
SimulationConfig rollingOctagon() {
  constexpr double SLOPE = 0.1, SPOKE = 0.2, LAYER = 1e-4, SPEED = 4, HEIGHT = 0.18477590650225735;  // SPOKE cos(pi / 8)
  geometry::TriangleMesh octagon;
  for (int i = 0; i < 8; ++i)
    for (const double y : {-0.1, 0.1})
      octagon.vertices.emplace_back(SPOKE * std::cos((i + 0.5) * M_PI / 4), y, SPOKE * std::sin((i + 0.5) * M_PI / 4));
  for (int a = 0; a < 16; a += 2) {
    const int b = (a + 2) % 16;
    octagon.elements.insert(octagon.elements.end(), {{a, a + 1, b}, {b, a + 1, b + 1}});
    if (a >= 2 && a < 14) octagon.elements.insert(octagon.elements.end(), {{0, a, b}, {1, b + 1, a + 1}});
  }
  SimulationConfig config;
  config.time_step = 2.5e-4;
  config.gravity = G * Vector3(std::sin(SLOPE), 0, -std::cos(SLOPE));
  config.contact.surface.friction = 2;
  config.contact.boundary_width = LAYER;
  EnvironmentConfig plane;
  plane.name = "plane";
  plane.plane = Eigen::Vector4d(0, 0, 1, 0);
  config.environments = {plane};
  ObjectConfig wheel;
  wheel.name = "wheel";
  wheel.uri = meshFile("octagon", octagon);
  wheel.mass = 2;
  wheel.com = Vector3::Zero();
  wheel.inertia = 0.02 * Matrix3::Identity();
  wheel.X_WO = makePose({0, 0, HEIGHT + LAYER});
  wheel.angular_velocity = {0, SPEED, 0};
  wheel.linear_velocity = {SPEED * HEIGHT, 0, 0};
  config.objects = {wheel};
  return config;
}

/** Parts of a step that differ in length press the spoke with 0.2 N or less and with 24 N in turn: what misses the law of Coulomb is little
 * of the mean. */
TEST(SolverTrouble, NoneWhereOnePartOfAStepHardlyPushes) {
  Simulator simulator(rollingOctagon(), model::UriResolver());
  for (int i = 0; i < 1000; ++i) {
    const StepReport& report = simulator.step();
    ASSERT_EQ(report.status & SOLVER_TROUBLE, 0u) << i << ": " << report.solver_residual << " N";
  }
}

}  // namespace
}  // namespace blem_sim::sim
