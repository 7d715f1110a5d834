// Live meshes that come into bodies.
#include <cmath>
#include <vector>

#include "blem_sim/sim/named_parts.h"
#include "sim/clouds/live_mesh_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double FAST_FADE = 0.002;  // [m/s] so that tests take less time

SimulationConfig cubeAboveFastMesh() {
  SimulationConfig config = cubeAboveMesh();
  config.environments[0].live.fade_speed = FAST_FADE;
  return config;
}

TEST(LiveMesh, AMeshThatComesIntoABodyLiftsItOut) {
  Simulator simulator(cubeAboveFastMesh(), model::UriResolver());
  SeenFloor floor(0.3, 0);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const double rest = bodyOf(simulator, "cube").X_WB.translation().z();
  exchange(&simulator, floor.next(0.004));
  for (int i = 0; i < 2000; ++i) {
    simulator.step();
    ASSERT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 1.1 * FAST_FADE) << i;
  }
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), rest + 0.004, 2e-5);
  stepFor(&simulator, 1);
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), rest + 0.004, 1e-5);
  EXPECT_EQ(simulator.report().status, STEP_OK);
}

TEST(LiveMesh, NothingSinksThroughAStreamThatComesHigher) {
  Simulator simulator(cubeAboveFastMesh(), model::UriResolver());
  SeenFloor floor(0.2);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const double rest = bodyOf(simulator, "cube").X_WB.translation().z();
  for (int i = 0; i < (SANITIZED ? 2 : 40); ++i) {
    exchange(&simulator, floor.next(0.004));
    for (int k = 0; k < 100; ++k) {
      simulator.step();
      ASSERT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 0.1) << i << " " << k;
      ASSERT_GT(bodyOf(simulator, "cube").X_WB.translation().z(), rest - 0.001) << i << " " << k;
    }
  }
}

TEST(LiveMesh, WhatFallsIsCaughtByAMeshThatComesIntoIt) {
  Simulator simulator(cubeAboveMesh(0.1), model::UriResolver());
  SeenFloor floor(0.3, 0);
  stepFor(&simulator, 0.05);
  const double z = bodyOf(simulator, "cube").X_WB.translation().z();
  exchange(&simulator, floor.next(z - 0.05 + 0.003));
  stepFor(&simulator, 0.5);
  EXPECT_NEAR(carriedBy(simulator.report()), G, 0.01 * G);
  EXPECT_GT(bodyOf(simulator, "cube").X_WB.translation().z(), z - 0.001);
}

TEST(LiveMesh, AStateSavedWhileABodyIsLiftedIsRestoredToTheSameBits) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver());
  SeenFloor floor(0.2);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.2);
  exchange(&simulator, floor.next(0.004));
  stepFor(&simulator, 0.05);
  const SimulationState state = simulator.save();
  stepFor(&simulator, 0.1);
  const std::uint64_t end = simulator.stateHash();
  simulator.restore(state);
  stepFor(&simulator, 0.1);
  EXPECT_EQ(simulator.stateHash(), end);
}

TEST(LiveMesh, CornersInTwoBodiesThatCrossRiseOnce) {
  SimulationConfig config = cubeAboveMesh(0.05);
  config.objects.push_back(box("other", Vector3::Constant(0.1), 1, {0.061, 0.002, 0.05}));
  Simulator simulator(config, model::UriResolver());
  exchange(&simulator, SeenFloor(0.3, 0).next(0.005));
  const SimulationState state = simulator.save();
  stepFor(&simulator, 0.05);
  const std::uint64_t end = simulator.stateHash();
  simulator.restore(state);
  stepFor(&simulator, 0.05);
  EXPECT_EQ(simulator.stateHash(), end);
}

TEST(LiveMesh, WhatIsWeldedToItDoesNotTouchTheNextOne) {
  Simulator simulator(cubeAboveMesh(0.053), model::UriResolver());
  SeenFloor floor(0.2);
  exchange(&simulator, floor.next());
  simulator.attach("cube", findLink(simulator, "live::link", "test"), INFINITY, INFINITY);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(simulator.step().contacts.empty()) << i;
    exchange(&simulator, floor.next());
  }
  simulator.detach("cube");
  stepFor(&simulator, 0.1);
  EXPECT_FALSE(simulator.report().contacts.empty());
}

}  // namespace
}  // namespace blem_sim::sim
