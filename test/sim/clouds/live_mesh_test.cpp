// Live environments of triangles: meshes that are exchanged below bodies that stand on them.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "sim/clouds/live_mesh_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

/** Figures of a stand on meshes that come at 10 Hz. */
struct Stay {
  double change = 0;  // [of the weight] largest, of the force of all contacts, from step to step
  double of_layer = 0;
  double lowest = INFINITY, highest = -INFINITY;  // [m] of the first body
  bool pierced = false;
};

Stay stayOn(Simulator* simulator, SeenFloor* floor, int updates, Mesher mesher = Mesher::AUTO) {
  Stay stay;
  const double weight = weightOf(simulator->world());
  double before = carriedBy(simulator->report());
  for (int i = 0; i < updates; ++i) {
    exchange(simulator, floor->next(), mesher);
    for (int k = 0; k < 100; ++k) {
      const double now = carriedBy(simulator->step());
      stay.change = std::max(stay.change, std::abs(now - before) / weight);
      before = now;
      stay.of_layer = std::max(stay.of_layer, simulator->report().max_of_layer);
      for (const ContactReport& contact : simulator->report().contacts) stay.pierced = stay.pierced || contact.pierced;
    }
    const double z = simulator->report().bodies[0].X_WB.translation().z();
    stay.lowest = std::min(stay.lowest, z);
    stay.highest = std::max(stay.highest, z);
  }
  return stay;
}

TEST(LiveMesh, UpdatesWithFreshNoiseJerkNothing) {
  for (const Mesher mesher : {Mesher::ORGANIZED, Mesher::GREEDY_PROJECTION}) {
    Simulator simulator(cubeAboveMesh(), model::UriResolver());
    SeenFloor floor(0.2);
    exchange(&simulator, floor.next(), mesher);
    stepFor(&simulator, 0.5);
    const Stay stay = stayOn(&simulator, &floor, SANITIZED ? 4 : 40, mesher);
    testing::Test::RecordProperty(std::string("change_of_the_force_") + mesherName(mesher), std::to_string(stay.change));
    EXPECT_LT(stay.change, 0.05) << mesherName(mesher);
    EXPECT_LT(stay.of_layer, 1) << mesherName(mesher);
    EXPECT_FALSE(stay.pierced) << mesherName(mesher);
    EXPECT_GT(stay.lowest, 0.05 + CUBE_WIDTH) << mesherName(mesher);
    EXPECT_LT(stay.highest, 0.05 + CUBE_WIDTH + 5 * ROUGHNESS) << mesherName(mesher);
  }
}

TEST(LiveMesh, AHumanoidStandsOnAStream) {
  const std::string source = BLEM_SIM_SOURCE_DIR;
  SimulationConfig config = loadConfigFile(source + "/config/demo_point_cloud.yaml");
  EnvironmentConfig floor_of_triangles = liveMesh();
  floor_of_triangles.contact = config.environments[0].contact;
  config.environments = {floor_of_triangles};
  Simulator simulator(config, model::UriResolver({{"blem_sim", source}}));
  SeenFloor floor(1);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 2);
  const double height = simulator.report().bodies[0].X_WB.translation().z();
  const Stay stay = stayOn(&simulator, &floor, SANITIZED ? 3 : 20);
  EXPECT_NEAR(carriedBy(simulator.report()), weightOf(simulator.world()), 0.02 * weightOf(simulator.world()));
  testing::Test::RecordProperty("change_of_the_force", std::to_string(stay.change));
  EXPECT_LT(stay.change, 0.05);
  EXPECT_LT(stay.of_layer, 1);
  EXPECT_FALSE(stay.pierced);
  EXPECT_NEAR(simulator.report().bodies[0].X_WB.translation().z(), height, 0.005);
}

TEST(LiveMesh, AFloorThatRisesLiftsSlowly) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver());
  SeenFloor floor(0.3, 0);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const double rest = bodyOf(simulator, "cube").X_WB.translation().z();
  constexpr double RISES = SANITIZED ? 0.00025 : 0.001;  // [m]
  exchange(&simulator, floor.next(RISES));
  for (int i = 0; i < 6e6 * RISES; ++i) {  // half as long again as fading takes
    simulator.step();
    ASSERT_LT(bodyOf(simulator, "cube").v_WCom.z(), 0.00075) << i;
  }
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), rest + RISES, 1e-5);
}

TEST(LiveMesh, AFloorThatIsLowerIsReachedSlowly) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver());
  SeenFloor floor(0.3, 0);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const double rest = bodyOf(simulator, "cube").X_WB.translation().z();
  exchange(&simulator, floor.next(-0.001));
  for (int i = 0; i < 6000; ++i) {
    simulator.step();
    ASSERT_GT(bodyOf(simulator, "cube").v_WCom.z(), -0.00075) << i;
  }
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), rest - 0.001, 1e-5);
}

/** A floor with a box about the cube, as a camera sees that: a sheet that lies half inside the cube. */
model::SensedCloud floorWithCube(SeenFloor* floor, const Vector3& centre, std::mt19937* random) {
  std::normal_distribution<double> noise(0, 0.002);
  model::SensedCloud cloud = floor->next();
  for (Vector3& p : cloud.points)
    if ((p - centre).head<2>().cwiseAbs().maxCoeff() < 0.052) p.z() = centre.z() + 0.05 + noise(*random);
  return cloud;
}

/** A cube in the air, where nothing holds it. @param speed [m/s] along x */
SimulationConfig floatingCube(double speed) {
  SimulationConfig config = cubeAboveMesh(0.3);
  config.gravity = Vector3::Zero();
  config.objects[0].linear_velocity = Vector3(speed, 0, 0);
  return config;
}

TEST(LiveMesh, ABodySeenInItsOwnCloudIsNotThrown) {
  Simulator simulator(floatingCube(0), model::UriResolver());
  SeenFloor floor(0.3, 0.0002);
  std::mt19937 random(3);
  const Vector3 rest = bodyOf(simulator, "cube").X_WB.translation();
  for (int i = 0; i < (SANITIZED ? 2 : 5); ++i) {
    exchange(&simulator, floorWithCube(&floor, rest, &random));
    for (int k = 0; k < 100; ++k) {
      EXPECT_EQ(simulator.step().status & (CONTACT_UNRELIABLE | SOLVER_TROUBLE | STEP_SHORTENED), 0u) << i << " " << k;
      ASSERT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 0.001) << i << " " << k;
    }
  }
  EXPECT_LT((bodyOf(simulator, "cube").X_WB.translation() - rest).norm(), 0.001);
}

TEST(LiveMesh, ABodySeenInItsOwnCloudMovesFreely) {
  Simulator simulator(floatingCube(0.5), model::UriResolver());
  SeenFloor floor(0.3, 0);
  std::mt19937 random(3);
  for (int i = 0; i < 3; ++i) {
    exchange(&simulator, floorWithCube(&floor, bodyOf(simulator, "cube").X_WB.translation() - Vector3(0.01, 0, 0), &random));
    for (int k = 0; k < 20; ++k) EXPECT_EQ(simulator.step().status, STEP_OK) << i << " " << k;
  }
  EXPECT_NEAR(bodyOf(simulator, "cube").v_WCom.x(), 0.5, 0.01);
}

TEST(LiveMesh, WhatMovesAcrossAnExchangeGoesOn) {
  SimulationConfig config = cubeAboveMesh();
  config.environments[0].contact.friction = 0;
  config.objects[0].contact.friction = 0;
  Simulator simulator(config, model::UriResolver());
  SeenFloor floor(0.4, 0);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  dynamics::BodyState sliding = bodyOf(simulator, "cube");
  sliding.v_WCom = Vector3(0.05, 0.01, 0);
  simulator.moveModel(simulator.models()[simulator.modelIndex("cube")].bodies[0], sliding);
  for (int i = 0; i < 10; ++i) {
    exchange(&simulator, floor.next(i % 2 == 0 ? 0.0005 : 0));
    for (int k = 0; k < 100; ++k) {
      simulator.step();
      ASSERT_LT(std::abs(bodyOf(simulator, "cube").v_WCom.z()), 0.005) << i << " " << k;
    }
  }
  EXPECT_NEAR(bodyOf(simulator, "cube").v_WCom.x(), 0.05, 1e-4);
}

TEST(LiveMesh, SearchesAheadChangeNoBit) {
  std::uint64_t hashes[2];
  for (const bool ahead : {false, true}) {
    Simulator simulator(cubeAboveMesh(), model::UriResolver());
    SeenFloor floor(0.2);
    exchange(&simulator, floor.next());
    stepFor(&simulator, 0.3);
    for (int i = 0; i < 3; ++i) {
      CloudSurface surface = makeCloudSurface(floor.next(), liveMesh().cloud, "live");
      std::vector<SearchedAhead> searched = searchAhead(simulator.cloudNeighbours("live"), surface);
      EXPECT_EQ(searched.size(), 1u) << i;
      stepFor(&simulator, 0.02);
      simulator.updateCloud("live", &surface, ahead ? std::move(searched) : std::vector<SearchedAhead>());
      stepFor(&simulator, 0.1);
    }
    hashes[ahead] = simulator.stateHash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(LiveMesh, AStateSavedWhileItFadesIsRestoredToTheSameBits) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver());
  SeenFloor floor(0.2);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  for (int i = 0; i < 3; ++i) {
    exchange(&simulator, floor.next());
    stepFor(&simulator, 0.05);
  }
  const SimulationState state = simulator.save();
  stepFor(&simulator, 0.2);
  const std::uint64_t end = simulator.stateHash();
  simulator.restore(state);
  stepFor(&simulator, 0.2);
  EXPECT_EQ(simulator.stateHash(), end);
  exchange(&simulator, floor.next());
  EXPECT_THROW(simulator.restore(state), InputError);
}

TEST(LiveMesh, ResetEndsAllFading) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver()), fresh(cubeAboveMesh(), model::UriResolver());
  SeenFloor floor(0.2);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const model::SensedCloud last = floor.next();
  exchange(&simulator, last);
  simulator.step();
  simulator.resetSimulation();
  exchange(&fresh, last);
  for (Simulator* each : {&simulator, &fresh}) stepFor(each, 0.3);
  EXPECT_EQ(simulator.stateHash(), fresh.stateHash());
}

TEST(LiveMesh, AStateSavedAfterAResetKnowsThatFadingHasEnded) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver()), fresh(cubeAboveMesh(), model::UriResolver());
  SeenFloor floor(0.2);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const model::SensedCloud last = floor.next();
  exchange(&simulator, last);
  simulator.save();
  simulator.resetSimulation();
  exchange(&fresh, last);
  EXPECT_EQ(simulator.save().layout, fresh.save().layout);
  fresh.restore(simulator.save());
  EXPECT_EQ(simulator.stateHash(), fresh.stateHash());
}

/** Sum of the sizes of all contact forces [N]: above the weight where a body is squeezed. */
double pushesOf(const StepReport& report) {
  double force = 0;
  for (const ContactReport& contact : report.contacts) force += contact.force.norm();
  return force;
}

TEST(LiveMesh, ASheetThatACameraSawOfABodySqueezesNothing) {
  for (const double height : SANITIZED ? std::vector<double>{0.002} : std::vector<double>{0, 0.002, 0.003}) {
    SimulationConfig config = cubeAboveMesh();
    EnvironmentConfig ground;
    ground.name = "ground";
    ground.plane = Eigen::Vector4d(0, 0, 1, 0);
    config.environments.push_back(ground);
    Simulator simulator(config, model::UriResolver());
    SeenFloor top(0.09);
    stepFor(&simulator, 0.2);
    const double rest = bodyOf(simulator, "cube").X_WB.translation().z();
    for (int i = 0; i < (SANITIZED ? 1 : 3); ++i) {
      exchange(&simulator, top.next(rest + 0.05 + height));
      for (int k = 0; k < 200; ++k) ASSERT_NEAR(pushesOf(simulator.step()), G, 0.01 * G) << height << " " << i << " " << k;
    }
    EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), rest, 1e-6) << height;
  }
}

}  // namespace
}  // namespace blem_sim::sim
