// Live environments of triangles: meshes that are exchanged below bodies that stand on them.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/named_parts.h"
#include "blem_sim/sim/simulator_input.h"
#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

using Mesher = model::CloudOptions::Mesher;

constexpr double ROUGHNESS = 0.001;  // [m]
constexpr double CUBE_WIDTH = 0.0025;

/** A camera that sees a square floor about z = 0 from 1 m above, with fresh noise. */
class SeenFloor {
 public:
  explicit SeenFloor(double size, double noise = ROUGHNESS, double spacing = 0.005) : size_(size), spacing_(spacing), noise_(0, noise) {}
  model::SensedCloud next(double height = 0) {
    std::vector<Vector3> points;
    const int half = static_cast<int>(0.5 * size_ / spacing_);
    for (int i = -half; i <= half; ++i)
      for (int j = -half; j <= half; ++j) points.emplace_back(spacing_ * i, spacing_ * j, height + noise_(random_));
    model::SensedCloud cloud(points);
    cloud.width = cloud.height = 2 * half + 1;
    cloud.viewpoint = Vector3(0, 0, 1);
    return cloud;
  }

 private:
  double size_, spacing_;
  std::mt19937 random_{7};
  std::normal_distribution<double> noise_;
};

EnvironmentConfig liveMesh(Mesher mesher = Mesher::AUTO) {
  EnvironmentConfig environment;
  environment.name = "live";
  environment.live.topic = "/points";
  environment.cloud.as = model::CloudOptions::As::MESH;
  environment.cloud.mesher = mesher;
  return environment;
}

SimulationConfig cubeAboveMesh(double height = 0.06) {
  SimulationConfig config;
  config.environments = {liveMesh()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.001, 0.002, height})};
  return config;
}

void exchange(Simulator* simulator, const model::SensedCloud& cloud, Mesher mesher = Mesher::AUTO) {
  CloudSurface surface = makeCloudSurface(cloud, liveMesh(mesher).cloud, "live");
  simulator->updateCloud("live", &surface);
}

/** Upward force of all contacts on bodies [N]. */
double carriedBy(const StepReport& report) {
  double force = 0;
  for (const ContactReport& contact : report.contacts) force += (contact.body_a != dynamics::WORLD_BODY ? 1 : -1) * contact.force.z();
  return force;
}

double weightOf(const dynamics::World& world) {
  double mass = 0;
  for (int body = 0; body < world.bodyCount(); ++body) mass += world.bodySpec(body).inertial.mass;
  return mass * G;
}

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
  exchange(&simulator, floor.next(0.001));
  for (int i = 0; i < 6000; ++i) {
    simulator.step();
    ASSERT_LT(bodyOf(simulator, "cube").v_WCom.z(), 0.00075) << i;
  }
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), rest + 0.001, 1e-5);
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

/** Gives the calls of one simulation to another. */
class Twin : public SimulatorWatcher {
 public:
  explicit Twin(Simulator* twin) : twin_(twin) {}
  void told(const SimulatorInput& input) override { applyInput(input, twin_); }
  void stepped() override { twin_->step(); }

 private:
  Simulator* twin_;
};

TEST(LiveMesh, RecordedMeshesGiveTheSameBits) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver()), replayed(cubeAboveMesh(), model::UriResolver());
  Twin twin(&replayed);
  simulator.watch(&twin);
  SeenFloor floor(0.2);
  for (int i = 0; i < 4; ++i) {
    exchange(&simulator, floor.next());
    stepFor(&simulator, 0.1);
  }
  simulator.watch(nullptr);
  EXPECT_EQ(simulator.stateHash(), replayed.stateHash());
}

/** Every fourth triangle names a vertex twice. */
geometry::TriangleMesh malformedFloor() {
  geometry::TriangleMesh mesh = geometry::gridMesh(0.4, 0.4, 8, 8);
  for (std::size_t i = 0; i < mesh.elements.size(); i += 4) mesh.elements[i][2] = mesh.elements[i][0];
  return mesh;
}

TEST(LiveMesh, TrianglesThatNameAVertexTwiceAreNoSegments) {
  SimulationConfig config = cubeAboveMesh();
  config.environments[0].live.type = LiveConfig::Type::MESH;
  Simulator simulator(config, model::UriResolver()), replayed(config, model::UriResolver());
  Twin twin(&replayed);
  simulator.watch(&twin);
  CloudSurface surface = makeMeshSurface(malformedFloor(), "live");
  EXPECT_EQ(surface.report.degenerate, 32);
  EXPECT_EQ(surface.report.triangles, 96);
  EXPECT_EQ(surface.report.segments, 0);
  simulator.updateCloud("live", &surface);
  stepFor(&simulator, 0.1);
  simulator.watch(nullptr);
  EXPECT_EQ(simulator.stateHash(), replayed.stateHash());
  geometry::TriangleMesh nothing = geometry::gridMesh(1, 1, 1, 1);
  for (Vector3i& e : nothing.elements) e[2] = e[0];
  EXPECT_THROW(makeMeshSurface(nothing, "live"), InputError);
}

TEST(LiveMesh, SlotsAreUsedAgainHoweverOften) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver());
  SeenFloor floor(0.16, 0.0002, 0.02);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.3);
  for (int i = 0; i < (SANITIZED ? 100 : 1000); ++i) {
    exchange(&simulator, floor.next());
    if (i % 10 == 9) simulator.step();
  }
  EXPECT_EQ(simulator.models().size(), 2u);
  EXPECT_EQ(simulator.colliders().size(), 3u);
  EXPECT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 0.001);
}

TEST(LiveMesh, IsTakenAwayByASurfaceOfNothing) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver()), replayed(cubeAboveMesh(), model::UriResolver());
  Twin twin(&replayed);
  simulator.watch(&twin);
  SeenFloor floor(0.2);
  CloudSurface nothing;
  simulator.updateCloud("live", &nothing);
  EXPECT_EQ(simulator.colliders().size(), 1u);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.2);
  exchange(&simulator, floor.next());
  stepFor(&simulator, 0.01);
  EXPECT_NEAR(carriedBy(simulator.report()), G, 0.1 * G);
  simulator.updateCloud("live", &nothing);
  EXPECT_TRUE(nothing.geometry) << "the caller frees what was there";
  CloudSurface again;
  simulator.updateCloud("live", &again);
  EXPECT_FALSE(again.geometry);
  const double before = bodyOf(simulator, "cube").v_WCom.z();
  stepFor(&simulator, 0.1);
  EXPECT_NEAR(bodyOf(simulator, "cube").v_WCom.z(), before - 0.1 * G, 1e-9);
  exchange(&simulator, floor.next(-0.2));
  stepFor(&simulator, 0.5);
  EXPECT_NEAR(carriedBy(simulator.report()), G, 0.1 * G);
  simulator.watch(nullptr);
  EXPECT_EQ(simulator.stateHash(), replayed.stateHash());
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

TEST(LiveMesh, SettingsThatDoNotReachItAreTold) {
  SimulationConfig config = cubeAboveMesh();
  EXPECT_TRUE(Simulator(config, model::UriResolver()).notes().empty());
  config.contact.mending = model::Mending::OFF;
  config.environments[0].contact.shrink = true;
  const std::vector<std::string> notes = Simulator(config, model::UriResolver()).notes();
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0].find("live: shrink does not reach meshes of topics"), 0u);
  EXPECT_EQ(notes[1].find("live: contact.mend_meshes: false does not reach meshes of topics"), 0u);
  config.environments[0].cloud.as = model::CloudOptions::As::POINTS;
  EXPECT_TRUE(Simulator(config, model::UriResolver()).notes().empty());
}

TEST(LiveMesh, PointsAreNoTriangles) {
  Simulator simulator(cubeAboveMesh(), model::UriResolver());
  CloudSurface points = makeCloudSurface(std::vector<Vector3>{{0, 0, 0}}, model::CloudOptions(), "live");
  EXPECT_THROW(simulator.updateCloud("live", &points), InputError);
}

}  // namespace
}  // namespace blem_sim::sim
