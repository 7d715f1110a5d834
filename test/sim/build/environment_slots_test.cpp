// Environments that come and go: slots are used again, and a new environment is not taken for the old one.
#include "blem_sim/geometry/input_error.h"
#include "build/surface_library.h"
#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr int SWAPS = SANITIZED ? 1000 : 10000;

SimulationConfig cubeOnGround() {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.0525})};
  return config;
}

EnvironmentConfig named(EnvironmentConfig environment, const std::string& name) {
  environment.name = name;
  return environment;
}

TEST(EnvironmentSlots, AreUsedAgainHoweverOften) {
  Simulator simulator(cubeOnGround(), model::UriResolver());
  stepFor(&simulator, 0.01);
  EnvironmentConfig plane = named(EnvironmentConfig(), "ground");
  plane.plane = Eigen::Vector4d(0, 0, 1, 0);
  for (int i = 0; i < SWAPS; ++i) {
    simulator.unloadEnvironment("ground");
    simulator.loadEnvironment(i % 100 == 99 ? ground() : plane);  // reading a file takes longer than all the rest
    if (i % 10 == 9) simulator.step();
  }
  EXPECT_EQ(simulator.models().size(), 2u);
  EXPECT_EQ(simulator.colliders().size(), 2u);
  EXPECT_EQ(simulator.loadReport().size(), 2u);
  EXPECT_EQ(simulator.modelIndex("ground"), 0);
  EXPECT_EQ(simulator.step().searched_pairs, 1);
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), 0.0525, 1e-5);
}

TEST(EnvironmentSlots, TheLowestFreeOneIsTaken) {
  SimulationConfig config = cubeOnGround();
  for (const char* name : {"a", "b", "c"}) config.environments.push_back(named(ground(), name));
  Simulator simulator(config, model::UriResolver());
  for (const char* name : {"c", "a", "b"}) simulator.unloadEnvironment(name);
  for (const char* name : {"x", "y", "z"}) simulator.loadEnvironment(named(ground(), name));
  EXPECT_EQ(simulator.modelIndex("x"), 1);
  EXPECT_EQ(simulator.modelIndex("y"), 2);
  EXPECT_EQ(simulator.modelIndex("z"), 3);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(simulator.colliders()[i].model, i);
  EXPECT_EQ(simulator.modelIndex("a"), -1);
}

/** Bodies that touch a ground that is taken away are new to the next ground in its slot: the rebound of landed ones is gone with it. */
TEST(EnvironmentSlots, NothingIsTakenForWhatItWasBefore) {
  for (const char* stepper : {"articulated", "world_step", "quick_step"}) {
    SimulationConfig config = cubeOnGround();
    config.solver.stepper = stepper;
    config.objects[0].contact.restitution = 0.8;
    config.objects[0].X_WO = makePose({0, 0, 0.1});
    Simulator simulator(config, model::UriResolver());
    for (int i = 0; i < 1000 && simulator.report().contacts.empty(); ++i) simulator.step();
    ASSERT_FALSE(simulator.report().contacts.empty());
    simulator.unloadEnvironment("ground");
    EXPECT_TRUE(simulator.report().contacts.empty());
    EXPECT_EQ(simulator.report().deepest_a, -1);
    simulator.loadEnvironment(named(ground(), "next"));

    SimulationConfig fresh = config;
    fresh.environments = {named(ground(), "next")};
    fresh.objects[0].X_WO = bodyOf(simulator, "cube").X_WB;
    fresh.objects[0].linear_velocity = bodyOf(simulator, "cube").v_WCom;
    fresh.objects[0].angular_velocity = bodyOf(simulator, "cube").w_WB;
    Simulator other(fresh, model::UriResolver());
    for (int i = 0; i < 5; ++i) {
      simulator.step();
      other.step();
      // quick_step shuffles its rows by a seed that is its world's own.
      EXPECT_NEAR(bodyOf(simulator, "cube").v_WCom.z(), bodyOf(other, "cube").v_WCom.z(), 1e-5) << stepper << " " << i;
    }
  }
}

TEST(EnvironmentSlots, PairsOutsideTheirLayersAreForgottenWithTheirCollider) {
  SimulationConfig config = cubeOnGround();
  config.objects[0].X_WO = makePose(Vector3::Zero());
  Simulator simulator(config, model::UriResolver());
  ASSERT_EQ(simulator.step().layer_events.size(), 1u);
  simulator.unloadEnvironment("ground");
  const SimulationState between = simulator.save();
  const std::uint64_t hash = simulator.stateHash();
  simulator.restore(between);
  EXPECT_EQ(simulator.stateHash(), hash);
  EnvironmentConfig deep = ground();
  deep.X_WE = makePose({0, 0, -1});
  simulator.loadEnvironment(deep);
  EXPECT_TRUE(simulator.step().layer_events.empty());
  EXPECT_FALSE(simulator.report().status & CONTACT_UNRELIABLE);
}

TEST(EnvironmentSlots, AStopIsStillSaidAfterAnEnvironmentIsTakenOut) {
  SimulationConfig config = cubeOnGround();
  config.objects[0].mass = 1e-9;
  Simulator simulator(config, model::UriResolver());
  tearAway("cube", &simulator);
  ASSERT_TRUE(simulator.step().status & STATE_NOT_FINITE);
  simulator.unloadEnvironment("ground");
  EXPECT_TRUE(simulator.step().status & STATE_NOT_FINITE);
}

TEST(EnvironmentSlots, SurfacesThatNobodyHoldsAreForgotten) {
  SurfaceLibrary library;
  for (int i = 0; i < 60; ++i) {
    const SharedSurface surface = library.load(ground().uri, Vector3::Constant(1 + i), {}, [](const std::string&, double) {});
    ContactSettings settings;
    settings.shrink = true;
    settings.boundary_width = 0.001;
    geometry::MeshReport report;
    contact::Collider collider;
    library.fit(surface.geometry, settings, 0, &report, &collider);
    ASSERT_LE(library.remembered(), 3 * 16u) << i;
  }
}

TEST(EnvironmentSlots, AStateSavedBeforeASwapOfTheSameIsRestoredAfterIt) {
  Simulator simulator(cubeOnGround(), model::UriResolver());
  stepFor(&simulator, 0.02);
  const SimulationState saved = simulator.save();
  stepFor(&simulator, 0.02);
  const std::uint64_t end = simulator.stateHash();
  simulator.unloadEnvironment("ground");
  simulator.loadEnvironment(named(ground(2), "between"));
  stepFor(&simulator, 0.01);
  EXPECT_THROW(simulator.restore(saved), InputError);
  simulator.unloadEnvironment("between");
  simulator.loadEnvironment(ground());
  simulator.restore(saved);
  stepFor(&simulator, 0.02);
  EXPECT_EQ(simulator.stateHash(), end);
}

TEST(EnvironmentSlots, StatesOfOtherSlotsAreRefused) {
  SimulationConfig config = cubeOnGround();
  config.environments.push_back(named(ground(), "second"));
  Simulator simulator(config, model::UriResolver());
  const SimulationState saved = simulator.save();
  for (const char* name : {"ground", "second"}) simulator.unloadEnvironment(name);
  for (const char* name : {"second", "ground"}) simulator.loadEnvironment(named(ground(), name));
  EXPECT_THROW(simulator.restore(saved), InputError);
}

}  // namespace
}  // namespace blem_sim::sim
