// Our humanoid on a floor that is streamed: 300,000 points with fresh noise, ten times a second of simulated time; and of the wall's,
// exchanged when they are built beside the steps, as the node does it.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <random>
#include <string>
#include <thread>
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
  std::vector<double> seconds;    // of each step, with the exchange before it if no other thread builds
  std::vector<double> exchanges;  // [s] each, where they are made in the time between steps
  double change = 0;              // [of the weight] largest, of the force of all contacts, from step to step
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
  return stand;
}

double slowest(std::vector<double> seconds, double part) {
  constexpr double MILLI = 1e-3;
  std::sort(seconds.begin(), seconds.end());
  return seconds[static_cast<std::size_t>(part * (seconds.size() - 1))] / MILLI;
}

/** Builds surfaces beside the steps: one after the other, each begun when the last is taken and a period has passed. */
class BesideTheSteps {
 public:
  BesideTheSteps(const sim::Simulator& simulator, std::string floor) : simulator_(simulator), floor_(std::move(floor)) {
    std::mt19937 random(3);
    for (int i = 0; i < CLOUDS; ++i) clouds_.push_back(floorCloud(&random));
  }
  /** Starts what may be started. @param step number of the step to come */
  void look(int step) {
    if (step >= next_ && !built_.valid() && !searched_.valid()) {
      next_ = std::max(next_ + PERIOD, step);
      built_ = std::async(std::launch::async, [this] { return make(clouds_[turn_++ % CLOUDS]); });
    }
    if (!isReady(built_)) return;
    searched_ = std::async(std::launch::async, [neighbours = simulator_.cloudNeighbours(floor_), surface = built_.get()]() mutable {
      std::vector<sim::SearchedAhead> ahead = sim::searchAhead(neighbours, surface);
      return Built{std::move(surface), std::move(ahead)};
    });
  }
  /** Exchanges the floor if a surface is ready. @param seconds of exchanges, to which that is added */
  void exchange(sim::Simulator* simulator, std::vector<double>* seconds) {
    if (!isReady(searched_)) return;
    Built built = searched_.get();
    const double start = threadSeconds();
    simulator->updateCloud(floor_, &built.surface, std::move(built.ahead));
    seconds->push_back(threadSeconds() - start);
    freed_ = std::async(std::launch::async, [old = std::move(built)] {});
  }
  sim::CloudSurface make(const model::SensedCloud& cloud) const {
    return sim::makeCloudSurface(cloud, simulator_.config().environments[0].cloud, floor_);
  }
  const model::SensedCloud& first() const { return clouds_.front(); }

 private:
  static constexpr int CLOUDS = 8;
  struct Built {
    sim::CloudSurface surface;
    std::vector<sim::SearchedAhead> ahead;
  };
  template <typename Result>
  static bool isReady(const std::future<Result>& future) {
    return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

  const sim::Simulator& simulator_;
  const std::string floor_;
  std::vector<model::SensedCloud> clouds_;
  int next_ = 0, turn_ = 0;
  std::future<sim::CloudSurface> built_;
  std::future<Built> searched_;
  std::future<void> freed_;
};

using Clock = std::chrono::steady_clock;

/** Waits for a step's time as the node does. @param busily busy_wait */
void waitUntil(Clock::time_point due, bool busily) {
  if (!busily) std::this_thread::sleep_until(due);
  while (Clock::now() < due) {
  }
}

/** In time with the wall's clock; exchanges take place in the time between steps. */
Stand standInRealTime(bool streamed, bool busily, int steps) {
  const std::string source = BLEM_SIM_SOURCE_DIR;
  const sim::SimulationConfig config = humanoidOnStream(source, As::POINTS);
  sim::Simulator simulator(config, model::UriResolver({{"blem_sim", source}}));
  BesideTheSteps beside(simulator, config.environments[0].name);
  sim::CloudSurface surface = beside.make(beside.first());
  simulator.updateCloud(config.environments[0].name, &surface, {});
  for (int i = 0; i < 2000; ++i) simulator.step();
  Stand stand;
  double force = weightOf(simulator.world());
  Clock::time_point due = Clock::now();
  for (int i = 0; i < steps; ++i) {
    due = std::max(due + std::chrono::milliseconds(1), Clock::now() - std::chrono::milliseconds(2));
    waitUntil(due, busily);
    const double start = threadSeconds();
    const sim::StepReport& report = simulator.step();
    stand.seconds.push_back(threadSeconds() - start);
    const double now = forceOf(report);
    stand.change = std::max(stand.change, std::abs(now - force) / weightOf(simulator.world()));
    stand.of_layer = std::max(stand.of_layer, report.max_of_layer);
    force = now;
    if (streamed) beside.look(i);
    beside.exchange(&simulator, &stand.exchanges);
  }
  return stand;
}

/** Tells figures of a streamed floor and holds them to what is promised. */
void judge(const std::string& name, const Stand& streamed) {
  figure(name + ": step, 98 % streamed", slowest(streamed.seconds, 0.98), "ms");
  figure(name + ": step, 99 % streamed", slowest(streamed.seconds, 0.99), "ms");
  figure(name + ": slowest step, at an exchange", slowest(streamed.seconds, 1), "ms");
  figure(name + ": change of the force within a step", streamed.change, "of the weight");
  figure(name + ": layer used up", streamed.of_layer, "of the layer");
  EXPECT_LT(streamed.change, 0.05);
  EXPECT_LT(streamed.of_layer, 1);
  EXPECT_LT(streamed.fall, 0.005);
}

TEST(LiveFloor, AHumanoidStandsOn300000Points) {
  const int steps = soakSteps(60, 1);
  figure("live floor: step, 99 % on one cloud", slowest(stand(As::POINTS, false, steps).seconds, 0.99), "ms");
  judge("live floor", stand(As::POINTS, true, steps));
}

void judgeInRealTime(const std::string& name, bool busily) {
  const int steps = soakSteps(60, 1);
  const Stand still = standInRealTime(false, busily, steps), streamed = standInRealTime(true, busily, steps);
  for (const double part : {0.5, 0.98, 0.99, 1.0}) {
    const std::string steps_of_part = name + ": step, " + std::to_string(part) + " of them, ";
    figure(steps_of_part + "on one cloud", slowest(still.seconds, part), "ms");
    figure(steps_of_part + "streamed", slowest(streamed.seconds, part), "ms");
  }
  ASSERT_FALSE(streamed.exchanges.empty());
  figure(name + ": exchanges between steps", streamed.exchanges.size(), "");
  figure(name + ": exchange, median", slowest(streamed.exchanges, 0.5), "ms");
  figure(name + ": slowest exchange", slowest(streamed.exchanges, 1), "ms");
  EXPECT_LT(streamed.change, 0.05);
  EXPECT_LT(streamed.of_layer, 1);
}

TEST(LiveFloor, AHumanoidStandsInRealTime) { judgeInRealTime("live floor in real time", false); }
TEST(LiveFloor, AHumanoidStandsInRealTimeWithoutSleep) { judgeInRealTime("live floor in real time, busy_wait", true); }

TEST(LiveFloor, AHumanoidStandsOnAMeshOf300000Points) { judge("live mesh", stand(As::MESH, true, soakSteps(10, 1))); }

}  // namespace
}  // namespace blem_sim
