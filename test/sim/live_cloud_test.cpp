// Live environments: clouds that are exchanged below bodies that stand on them.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double NOISE = 0.001;  // [m]
constexpr double CUBE_LAYER = 0.0025;

/** A square floor of points about z = 0 with fresh noise. */
class NoisyFloor {
 public:
  NoisyFloor(double size, double spacing, double noise) : size_(size), spacing_(spacing), noise_(0, noise) {}
  std::vector<Vector3> next() {
    std::vector<Vector3> points;
    const int half = static_cast<int>(0.5 * size_ / spacing_);
    for (int i = -half; i <= half; ++i)
      for (int j = -half; j <= half; ++j) points.emplace_back(spacing_ * i, spacing_ * j, noise_(random_));
    return points;
  }

 private:
  double size_, spacing_;
  std::mt19937 random_{7};
  std::normal_distribution<double> noise_;
};

EnvironmentConfig live() {
  EnvironmentConfig environment;
  environment.name = "live";
  environment.live.topic = "/points";
  environment.cloud.point_radius = 0.0015;
  return environment;
}

SimulationConfig cubeAboveLive(double height = 0.06) {
  SimulationConfig config;
  config.environments = {live()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.001, 0.002, height})};
  return config;
}

void update(Simulator* simulator, const std::vector<Vector3>& points) {
  CloudSurface surface = makeCloudSurface(points, live().cloud, "live");
  simulator->updateCloud("live", &surface);
}

TEST(AutoRadius, ABoxRestsWithinAThirdOfTheSpacing) {
  for (const double spacing : {0.002, 0.005, 0.01, 0.02}) {
    SimulationConfig config;
    config.environments = {pointCloud("auto" + std::to_string(spacing), NoisyFloor(0.3, spacing, 0).next())};
    config.environments[0].cloud.auto_radius = true;
    config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.003, 0.004, 0.06})};
    Simulator simulator(config, model::UriResolver());
    stepFor(&simulator, 0.5);
    const double above = bodyOf(simulator, "cube").X_WB.translation().z() - 0.05 - CUBE_LAYER;
    EXPECT_GT(above, 0) << spacing;
    EXPECT_LT(above, spacing / 3) << spacing;
    EXPECT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 1e-4) << spacing;
  }
}

TEST(LiveCloud, IsNothingUntilPointsCome) {
  Simulator simulator(cubeAboveLive(), model::UriResolver());
  stepFor(&simulator, 0.1);
  EXPECT_NEAR(bodyOf(simulator, "cube").v_WCom.z(), -0.1 * G, 1e-9);
  EXPECT_EQ(simulator.models().size(), 2u);
}

/** Largest change of the force on the cube [of its weight] from step to step, and the worst of its layer used up, over updates at 10 Hz. */
struct Ride {
  double largest_change = 0, of_layer = 0, lowest = 1, highest = 0;
};

Ride ride(Simulator* simulator, NoisyFloor* floor, int updates) {
  Ride ride;
  double speed = bodyOf(*simulator, "cube").v_WCom.z(), force = 1;
  for (int i = 0; i < updates; ++i) {
    update(simulator, floor->next());
    for (int k = 0; k < 100; ++k) {
      const StepReport& report = simulator->step();
      const double now = bodyOf(*simulator, "cube").v_WCom.z(), weight = 1 + (now - speed) / (simulator->config().time_step * G);
      ride.largest_change = std::max({ride.largest_change, std::abs(weight - force), std::abs(weight - 1)});
      ride.of_layer = std::max(ride.of_layer, report.max_of_layer);
      speed = now;
      force = weight;
    }
    const double z = bodyOf(*simulator, "cube").X_WB.translation().z();
    ride.lowest = std::min(ride.lowest, z);
    ride.highest = std::max(ride.highest, z);
  }
  return ride;
}

TEST(LiveCloud, UpdatesWithFreshNoiseJerkNothing) {
  Simulator simulator(cubeAboveLive(), model::UriResolver());
  NoisyFloor floor(0.3, 0.005, NOISE);
  update(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const Ride result = ride(&simulator, &floor, 40);
  EXPECT_LT(result.largest_change, 0.05);
  EXPECT_LT(result.of_layer, 1);
  EXPECT_GT(result.lowest, 0.05 + CUBE_LAYER + 0.0015);
  EXPECT_LT(result.highest, 0.05 + CUBE_LAYER + 0.0015 + 5 * NOISE);
}

/** Upward force of all contacts on bodies [N]. */
double lift(const StepReport& report) {
  double force = 0;
  for (const ContactReport& contact : report.contacts) force += (contact.body_a != dynamics::WORLD_BODY ? 1 : -1) * contact.force.z();
  return force;
}

double massOf(const dynamics::World& world) {
  double mass = 0;
  for (int body = 0; body < world.bodyCount(); ++body) mass += world.bodySpec(body).inertial.mass;
  return mass;
}

TEST(LiveCloud, AHumanoidStandsOnAStream) {
  const std::string source = BLEM_SIM_SOURCE_DIR;
  SimulationConfig config = loadConfigFile(source + "/config/demo_point_cloud.yaml");
  EnvironmentConfig floor_of_points = live();
  floor_of_points.contact = config.environments[0].contact;
  config.environments = {floor_of_points};
  Simulator simulator(config, model::UriResolver({{"blem_sim", source}}));
  NoisyFloor floor(1, 0.005, NOISE);
  update(&simulator, floor.next());
  stepFor(&simulator, 2);
  const double weight = massOf(simulator.world()) * G, height = simulator.report().bodies[0].X_WB.translation().z();
  double before = lift(simulator.report()), change = 0, of_layer = 0;
  for (int i = 0; i < (SANITIZED ? 3 : 20); ++i) {
    update(&simulator, floor.next());
    for (int k = 0; k < 100; ++k) {
      const double now = lift(simulator.step());
      change = std::max(change, std::abs(now - before));
      before = now;
      of_layer = std::max(of_layer, simulator.report().max_of_layer);
    }
  }
  EXPECT_NEAR(before, weight, 0.02 * weight);
  EXPECT_LT(change, 0.05 * weight);
  EXPECT_LT(of_layer, 1);
  EXPECT_NEAR(simulator.report().bodies[0].X_WB.translation().z(), height, 0.005);
}

TEST(LiveCloud, WhatAppearsInsideALayerLiftsSlowly) {
  Simulator simulator(cubeAboveLive(), model::UriResolver());
  NoisyFloor floor(0.3, 0.005, 0);
  update(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const double rest = bodyOf(simulator, "cube").X_WB.translation().z();
  std::vector<Vector3> higher = floor.next();
  constexpr double MILLIMETRES = SANITIZED ? 0.25 : 2;
  for (Vector3& p : higher) p.z() += 0.001 * MILLIMETRES;
  update(&simulator, higher);
  for (int i = 0; i < 6000 * MILLIMETRES; ++i) {
    simulator.step();
    ASSERT_LT(bodyOf(simulator, "cube").v_WCom.z(), 0.00075) << i;  // it rocks
  }
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), rest + 0.001 * MILLIMETRES, 1e-5);
}

TEST(LiveCloud, WhatIsTakenAwaySinksSlowly) {
  Simulator simulator(cubeAboveLive(), model::UriResolver());
  NoisyFloor floor(0.3, 0.005, 0);
  update(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const double rest = bodyOf(simulator, "cube").X_WB.translation().z();
  std::vector<Vector3> lower = floor.next();
  for (Vector3& p : lower) p.z() -= 0.001;
  update(&simulator, lower);
  for (int i = 0; i < 6000; ++i) {
    simulator.step();
    ASSERT_GT(bodyOf(simulator, "cube").v_WCom.z(), -0.00075) << i;
  }
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), rest - 0.001, 1e-5);
}

TEST(LiveCloud, PointsInsideABodyCountForNothing) {
  SimulationConfig config = cubeAboveLive();
  config.environments[0].live.fade_speed = 0.05;  // what counted would push soon
  Simulator simulator(config, model::UriResolver()), seen(config, model::UriResolver());
  NoisyFloor floor(0.3, 0.005, 0);
  for (Simulator* each : {&simulator, &seen}) {
    update(each, floor.next());
    stepFor(each, 0.5);
  }
  // A camera that sees the cube itself, a millimetre inside its bottom and a centimetre inside its side.
  std::vector<Vector3> with_cube = floor.next();
  const double bottom = bodyOf(seen, "cube").X_WB.translation().z() - 0.05;
  for (int i = -5; i <= 5; ++i) {
    with_cube.emplace_back(0.008 * i, 0, bottom + 0.001);
    with_cube.emplace_back(0.04, 0.008 * i, 0.06);
  }
  update(&simulator, floor.next());
  update(&seen, with_cube);
  for (Simulator* each : {&simulator, &seen}) stepFor(each, 0.5);
  EXPECT_LT((bodyOf(simulator, "cube").X_WB.matrix() - bodyOf(seen, "cube").X_WB.matrix()).norm(), 1e-7);
  EXPECT_LT(seen.report().max_of_layer, 0.01);
}

TEST(LiveCloud, SlotsAreUsedAgainHoweverOften) {
  Simulator simulator(cubeAboveLive(), model::UriResolver());
  NoisyFloor floor(0.16, 0.02, 0.0002);
  update(&simulator, floor.next());
  stepFor(&simulator, 0.3);
  const int updates = SANITIZED ? 500 : 10000;
  for (int i = 0; i < updates; ++i) {
    update(&simulator, floor.next());
    if (i % 10 == 9) simulator.step();
  }
  EXPECT_EQ(simulator.models().size(), 2u);
  EXPECT_EQ(simulator.colliders().size(), 3u);
  EXPECT_LE(simulator.loadReport().size(), 3u);
  EXPECT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 0.001);
}

TEST(LiveCloud, AStateSavedWhilePointsFadeIsRestoredToTheSameBits) {
  Simulator simulator(cubeAboveLive(), model::UriResolver());
  NoisyFloor floor(0.3, 0.005, NOISE);
  update(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  update(&simulator, floor.next());
  stepFor(&simulator, 0.05);
  const SimulationState state = simulator.save();
  stepFor(&simulator, 0.2);
  const std::uint64_t end = simulator.stateHash();
  simulator.restore(state);
  stepFor(&simulator, 0.2);
  EXPECT_EQ(simulator.stateHash(), end);
  update(&simulator, floor.next());
  EXPECT_THROW(simulator.restore(state), InputError);
}

TEST(LiveCloud, TheSameUpdatesGiveTheSameBits) {
  std::uint64_t hashes[2];
  for (std::uint64_t& hash : hashes) {
    Simulator simulator(cubeAboveLive(), model::UriResolver());
    NoisyFloor floor(0.3, 0.005, NOISE);
    for (int i = 0; i < 5; ++i) {
      update(&simulator, floor.next());
      stepFor(&simulator, 0.1);
    }
    hash = simulator.stateHash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(LiveCloud, SearchesAheadChangeNoBit) {
  std::uint64_t hashes[2];
  for (const bool ahead : {false, true}) {
    Simulator simulator(cubeAboveLive(), model::UriResolver());
    NoisyFloor floor(0.3, 0.005, NOISE);
    for (int i = 0; i < 5; ++i) {
      CloudSurface surface = makeCloudSurface(floor.next(), live().cloud, "live");
      std::vector<SearchedAhead> searched = searchAhead(simulator.cloudNeighbours("live"), surface);
      EXPECT_EQ(searched.size(), i < 1 ? 0 : 1) << i;
      stepFor(&simulator, 0.02);
      simulator.updateCloud("live", &surface, ahead ? std::move(searched) : std::vector<SearchedAhead>());
      stepFor(&simulator, 0.1);
    }
    hashes[ahead] = simulator.stateHash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(LiveCloud, ContactsGoOnWhenItIsExchanged) {
  Simulator simulator(cubeAboveLive(), model::UriResolver());
  NoisyFloor floor(0.3, 0.005, NOISE);
  update(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  std::vector<Vector3> lower = floor.next();
  for (Vector3& point : lower) point.z() -= 0.02;
  update(&simulator, lower);
  EXPECT_LE(simulator.step().solver_iterations, 2);
}

TEST(LiveCloud, IsUnloadedWithAllThatFades) {
  Simulator simulator(cubeAboveLive(), model::UriResolver());
  NoisyFloor floor(0.3, 0.005, NOISE);
  update(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  update(&simulator, floor.next());
  simulator.step();
  simulator.unloadEnvironment("live");
  EXPECT_EQ(simulator.loadReport().size(), 1u);
  stepFor(&simulator, 0.1);
  EXPECT_NEAR(bodyOf(simulator, "cube").v_WCom.z(), -0.1 * G, 0.01);
  EXPECT_THROW(update(&simulator, floor.next()), InputError);
}

TEST(LiveCloud, ResetEndsAllFading) {
  Simulator simulator(cubeAboveLive(), model::UriResolver()), fresh(cubeAboveLive(), model::UriResolver());
  NoisyFloor floor(0.3, 0.005, NOISE);
  update(&simulator, floor.next());
  stepFor(&simulator, 0.5);
  const std::vector<Vector3> last = floor.next();
  update(&simulator, last);
  simulator.step();
  simulator.resetSimulation();
  update(&fresh, last);
  EXPECT_EQ(simulator.stateHash(), fresh.stateHash());
  for (Simulator* each : {&simulator, &fresh}) stepFor(each, 0.3);
  EXPECT_EQ(simulator.stateHash(), fresh.stateHash());
}

}  // namespace
}  // namespace blem_sim::sim
