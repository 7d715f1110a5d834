// Our humanoid on a floor that is streamed: 300,000 points with fresh noise, ten times a second of simulated time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/sim/simulator.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

constexpr int COUNT = 547;       // points along each side
constexpr double SIDE = 2;       // [m]
constexpr double NOISE = 0.001;  // [m] standard deviation of heights
constexpr int PERIOD = 100;      // steps between clouds

/** On a pixel grid, as a camera above it sees the floor. */
model::SensedCloud floorCloud(std::mt19937* random) {
  std::normal_distribution<double> height(0, NOISE);
  std::vector<Vector3> points;
  for (int i = 0; i < COUNT; ++i)
    for (int j = 0; j < COUNT; ++j)
      points.push_back(Vector3(i, j, 0) * (SIDE / COUNT) + Vector3(-0.5 * SIDE, -0.5 * SIDE, height(*random)));
  model::SensedCloud cloud(points);
  cloud.width = cloud.height = COUNT;
  cloud.viewpoint = Vector3::UnitZ();
  return cloud;
}

using As = model::CloudOptions::As;

sim::SimulationConfig humanoidOnStream(const std::string& source, As as) {
  sim::SimulationConfig config = sim::loadConfigFile(source + "/config/demo_point_cloud.yaml");
  sim::EnvironmentConfig& floor = config.environments[0];
  floor.uri.clear();
  floor.live.topic = "/points";
  floor.cloud.as = as;
  floor.cloud.point_radius = model::pointRadius(SIDE / COUNT);
  return config;
}

/** Figures of one stand. */
struct Stand {
  std::vector<double> seconds;  // of each step, with the exchange before it
  double change = 0;            // [of the weight] largest, of the force of all contacts, from step to step
  double of_layer = 0;
  double fall = 0;  // [m]
};

double weightOf(const dynamics::World& world) {
  double mass = 0;
  for (int body = 0; body < world.bodyCount(); ++body) mass += world.bodySpec(body).inertial.mass;
  return mass * 9.81;
}

double forceOf(const sim::StepReport& report) {
  double force = 0;
  for (const sim::ContactReport& contact : report.contacts) force += (contact.body_a != dynamics::WORLD_BODY ? 1 : -1) * contact.force.z();
  return force;
}

Stand stand(As as, bool streamed, int steps) {
  const std::string source = BLEM_SIM_SOURCE_DIR;
  const sim::SimulationConfig config = humanoidOnStream(source, as);
  sim::Simulator simulator(config, model::UriResolver({{"blem_sim", source}}));
  const std::string& floor = config.environments[0].name;
  const double weight = weightOf(simulator.world());
  std::mt19937 random(3);
  Stand stand;
  double force = weight, height = 0;
  for (int i = -2000; i < steps; ++i) {
    sim::CloudSurface surface;
    const bool exchanged = i == -2000 || (streamed && i % PERIOD == 0);
    std::vector<sim::SearchedAhead> ahead;
    if (exchanged) {
      surface = sim::makeCloudSurface(floorCloud(&random), config.environments[0].cloud, floor);
      ahead = sim::searchAhead(simulator.cloudNeighbours(floor), surface);
    }
    const double start = threadSeconds();
    if (exchanged) simulator.updateCloud(floor, &surface, std::move(ahead));
    const sim::StepReport& report = simulator.step();
    const double seconds = threadSeconds() - start, now = forceOf(report), z = report.bodies[0].X_WB.translation().z();
    if (i >= 0) {
      stand.seconds.push_back(seconds);
      stand.change = std::max(stand.change, std::abs(now - force) / weight);
      stand.of_layer = std::max(stand.of_layer, report.max_of_layer);
      stand.fall = std::max(stand.fall, std::abs(z - height));
    } else {
      height = z;
    }
    force = now;
  }
  std::sort(stand.seconds.begin(), stand.seconds.end());
  return stand;
}

double slowest(const Stand& stand, double part) {
  constexpr double MILLI = 1e-3;
  return stand.seconds[static_cast<std::size_t>(part * (stand.seconds.size() - 1))] / MILLI;
}

/** Tells figures of a streamed floor and holds them to what is promised. */
void judge(const std::string& name, const Stand& streamed) {
  figure(name + ": step, 98 % streamed", slowest(streamed, 0.98), "ms");
  figure(name + ": step, 99 % streamed", slowest(streamed, 0.99), "ms");
  figure(name + ": slowest step, at an exchange", slowest(streamed, 1), "ms");
  figure(name + ": change of the force within a step", streamed.change, "of the weight");
  figure(name + ": layer used up", streamed.of_layer, "of the layer");
  EXPECT_LT(streamed.change, 0.05);
  EXPECT_LT(streamed.of_layer, 1);
  EXPECT_LT(streamed.fall, 0.005);
}

TEST(LiveFloor, AHumanoidStandsOn300000Points) {
  const int steps = soakSteps(60, 1);
  figure("live floor: step, 99 % on one cloud", slowest(stand(As::POINTS, false, steps), 0.99), "ms");
  judge("live floor", stand(As::POINTS, true, steps));
}

TEST(LiveFloor, AHumanoidStandsOnAMeshOf300000Points) { judge("live mesh", stand(As::MESH, true, soakSteps(10, 1))); }

}  // namespace
}  // namespace blem_sim
