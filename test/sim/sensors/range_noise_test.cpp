// Noise of depth cameras and lidars: its size, its steps, its streams.
#include <cmath>

#include "sim/sensors/range_scene.h"

namespace blem_sim::sim {
namespace {

TEST(RangeNoise, LidarHasItsDeviation) {
  SimulationConfig config = sceneWith(lidar());
  config.environments = {halfSpace({-1, 0, 0, -2})};
  RangeSensorConfig& rays = config.robots[0].sensors[0].rays;
  rays.first_angle = -1e-9;
  rays.last_angle = 1e-9;
  rays.beams = 40000;
  rays.stddev = 0.01;
  double sum = 0, sum_of_squares = 0;
  for (const float range : rangesIn(config)) {
    sum += range - 2;
    sum_of_squares += (range - 2.0) * (range - 2.0);
  }
  EXPECT_NEAR(sum / rays.beams, 0, 3 * 0.01 / std::sqrt(rays.beams));
  EXPECT_NEAR(std::sqrt(sum_of_squares / rays.beams), 0.01, 3 * 0.01 / std::sqrt(2.0 * rays.beams));
}

TEST(RangeNoise, KinectGrowsWithTheSquareOfTheDepthInStepsOfDisparity) {
  for (const double distance : {1.0, 3.0}) {
    RangeView view;
    view.rays.noise = RangeNoise::KINECT;
    view.noise_seed = 7;
    double sum_of_squares = 0;
    constexpr int COUNT = 40000;
    for (int i = 0; i < COUNT; ++i) {
      const double depth = measuredRange(view, static_cast<std::size_t>(i), distance), steps = 1 / (depth * 2.85e-3);
      EXPECT_NEAR(steps, std::round(steps), 1e-9);
      sum_of_squares += (depth - distance) * (depth - distance);
    }
    // Half a step of noise, and 1/sqrt(12) of one for the rounding.
    const double expected = 2.85e-3 * distance * distance * std::sqrt(0.25 + 1.0 / 12);
    EXPECT_NEAR(std::sqrt(sum_of_squares / COUNT), expected, 0.05 * expected);
  }
}

TEST(RangeNoise, IsTheSameAgainAndNewInEachReading) {
  SimulationConfig config = sceneWith(lidar());
  config.environments = {halfSpace({-1, 0, 0, -2})};
  config.robots[0].sensors[0].rays.stddev = 0.01;
  Simulator simulator(config, model::UriResolver()), again(config, model::UriResolver());
  const auto ranges = [](Simulator* of) { return rangesOf(*reading<LidarReading>(of->step(), 0).view); };
  const std::vector<float> first = ranges(&simulator), second = ranges(&simulator);
  EXPECT_EQ(first, ranges(&again));
  again.step();  // A reading that nobody draws changes nothing.
  EXPECT_NE(first, second);
  EXPECT_EQ(simulator.stateHash(), again.stateHash());
  EXPECT_EQ(ranges(&simulator), ranges(&again));
}

TEST(RangeNoise, IsNotInTheTruthBesideIt) {
  SimulationConfig config = sceneWith(lidar());
  config.environments = {halfSpace({-1, 0, 0, -2})};
  Simulator exact(config, model::UriResolver());
  config.robots[0].sensors[0].rays.stddev = 0.01;
  Simulator noisy(config, model::UriResolver());
  const SensorSample plain = exact.step().samples.at(0), erring = noisy.step().samples.at(0);
  const auto ranges = [](const SensorReading& reading) { return rangesOf(*std::get<LidarReading>(reading).view); };
  EXPECT_FALSE(plain.truth.has_value());
  EXPECT_EQ(ranges(erring.truth.value()), ranges(plain.reading));
  EXPECT_NE(ranges(erring.reading), ranges(plain.reading));
}

}  // namespace
}  // namespace blem_sim::sim
