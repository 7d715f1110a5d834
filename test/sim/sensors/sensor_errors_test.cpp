// Delay, range and resolution of sensors, and the truth beside them.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "blem_sim/sim/sensor_values.h"
#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

SensorConfig erringSensor(const std::string& name, SensorType type) {
  SensorConfig config;
  config.name = name;
  config.type = type;
  config.link = "arm";
  config.joint = "hinge";
  return config;
}

/** An imu, a wrench, a tilt and a motor's current, all with noise if they can, on a pendulum that is driven and swings. */
SimulationConfig swingingScene() {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  RobotConfig& pendulum = config.robots[0];
  pendulum.gains["default"] = {20, 0, 1};
  pendulum.sensors = {erringSensor("imu", SensorType::IMU), erringSensor("wrench", SensorType::FORCE_TORQUE),
                      erringSensor("tilt", SensorType::TILT), erringSensor("motors", SensorType::MOTOR_CURRENT)};
  pendulum.sensors[0].noise[0].stddev = pendulum.sensors[0].noise[1].bias_stddev = 0.1;
  for (QuantityNoise& noise : pendulum.sensors[1].noise) noise.stddev = 0.5;
  return config;
}

/** Numbers of a reading, empty where the sensor had none. */
std::vector<double> numbersOf(const StepReport& report, int sensor, bool truth = false) {
  for (const SensorSample& sample : report.samples)
    if (sample.sensor == sensor) return sensorValues(truth ? sample.truth.value() : sample.reading).values;
  return {};
}

/** Numbers of a sensor step by step. */
std::vector<std::vector<double>> record(const SimulationConfig& config, int sensor, bool truth = false, int steps = 60) {
  Simulator simulator(config, model::UriResolver());
  std::vector<std::vector<double>> numbers;
  for (int i = 0; i < steps; ++i) numbers.push_back(numbersOf(simulator.step(), sensor, truth));
  return numbers;
}

TEST(SensorDelay, ReadsWhatWasThereBefore) {
  const SimulationConfig at_once = swingingScene();
  for (const int which : {0, 1, 2, 3}) {
    SimulationConfig late = at_once;
    SensorConfig& sensor = late.robots[0].sensors[which];
    sensor.delay = 0.0069;
    sensor.noise = {};
    SimulationConfig exact = late;
    exact.robots[0].sensors[which].delay = 0;
    const auto before = record(exact, which), after = record(late, which);
    for (std::size_t i = 0; i < 7; ++i) EXPECT_TRUE(after[i].empty()) << which << " " << i;
    for (std::size_t i = 7; i < after.size(); ++i) ASSERT_EQ(after[i], before[i - 7]) << which << " " << i;
    EXPECT_NE(before[20], before[30]);
  }
}

TEST(SensorDelay, IsInWholeStepsWhateverTheRate) {
  SimulationConfig late = swingingScene();
  SensorConfig& tilt = late.robots[0].sensors[2];
  const auto every_step = record(late, 2);
  tilt.delay = 0.007;
  tilt.rate = 200;
  const auto after = record(late, 2);
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_EQ(after[i].empty(), i < 7 || (i + 1) % 5 != 0) << i;
    if (after[i].empty()) continue;
    ASSERT_EQ(after[i], every_step[i - 7]) << i;
  }
}

TEST(SensorDelay, LeavesTheNoiseAsItIs) {
  SimulationConfig config = swingingScene();
  const auto noisy = record(config, 1), truth = record(config, 1, true);
  config.robots[0].sensors[1].delay = 0.01;
  const auto late = record(config, 1);
  for (std::size_t i = 10; i < late.size(); ++i) {
    const std::size_t measured = i - 10;
    ASSERT_NEAR(late[i][0], truth[measured][0] + (noisy[measured][0] - truth[measured][0]), 1e-12) << i;
  }
  EXPECT_GT(std::abs(noisy[5][0] - truth[5][0]), 1e-3);
}

TEST(SensorDelay, IsSavedOnItsWay) {
  SimulationConfig config = swingingScene();
  for (SensorConfig& sensor : config.robots[0].sensors) sensor.delay = 0.01;
  for (const int step : {4, 25}) {  // before and after the first reading
    Simulator straight(config, model::UriResolver()), restored(config, model::UriResolver());
    for (int i = 0; i < step; ++i) straight.step();
    const SimulationState state = straight.save();
    restored.restore(state);
    ASSERT_EQ(restored.stateHash(), straight.stateHash());
    for (int i = 0; i < 30; ++i) {
      straight.step();
      restored.step();
      for (const int sensor : {0, 1, 2, 3}) ASSERT_EQ(numbersOf(restored.report(), sensor), numbersOf(straight.report(), sensor)) << i;
    }
    EXPECT_EQ(restored.stateHash(), straight.stateHash());
  }
}

TEST(SensorDelay, EndsWithAResetOrAnotherTimeStep) {
  SimulationConfig config = swingingScene();
  config.robots[0].sensors[2].delay = 0.01;
  Simulator simulator(config, model::UriResolver());
  const auto steps_until_reading = [&] {
    int steps = 1;
    while (numbersOf(simulator.step(), 2).empty()) ++steps;
    return steps;
  };
  EXPECT_EQ(steps_until_reading(), 11);
  simulator.resetWorld();
  EXPECT_EQ(steps_until_reading(), 11);
  simulator.setPhysics({0, 0, -1}, 0.001, 1);
  EXPECT_EQ(steps_until_reading(), 1);
  simulator.setPhysics({0, 0, -1}, 0.002, 1);
  EXPECT_EQ(steps_until_reading(), 6);
}

TEST(SensorLimits, HoldEveryQuantity) {
  for (const int which : {0, 1, 2, 3}) {
    SimulationConfig config = swingingScene();
    SensorConfig& sensor = config.robots[0].sensors[which];
    const auto free = record(config, which);
    const std::size_t width = which == 2 ? 5 : which == 3 ? 2 : 6, first = which == 2 ? 2 : which == 3 ? 1 : 3;
    double most[2] = {0, 0};
    for (const auto& numbers : free)
      for (std::size_t i = 0; i < width; ++i) most[i >= first] = std::max(most[i >= first], std::abs(numbers[i]));
    for (const int q : {0, 1}) sensor.limits[q] = {0.7 * most[q], 0.7 * most[q] / 3};
    const auto held = record(config, which);
    for (std::size_t step = 0; step < held.size(); ++step)
      for (std::size_t i = 0; i < width; ++i) {
        const QuantityLimits& limits = sensor.limits[i >= first];
        const double steps = std::round(free[step][i] / limits.resolution);
        EXPECT_NEAR(held[step][i], limits.resolution * std::max(-3.0, std::min(3.0, steps)), 1e-12) << which << " " << step << " " << i;
      }
  }
}

TEST(SensorLimits, ReadingsAreWholeStepsWithinTheRange) {
  SimulationConfig config = swingingScene();
  config.robots[0].sensors[1].limits[0] = {10, 3};
  config.robots[0].sensors[1].noise[0].stddev = 50;
  double most = 0;
  for (const auto& numbers : record(config, 1)) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(std::remainder(numbers[i], 3), 0);
    most = std::max(most, std::abs(numbers[0]));
  }
  EXPECT_EQ(most, 9);
}

TEST(SensorLimits, TurnTheOrientationOfATilt) {
  SimulationConfig config = swingingScene();
  config.robots[0].X_WR = makePose({0, 0, 0}, {0, 0, 0.7});
  config.robots[0].initial_positions["hinge"] = 0.6;
  config.robots[0].sensors[2].limits[0].saturation = 0.25;
  Simulator simulator(config, model::UriResolver());
  const TiltReading held = reading<TiltReading>(simulator.step(), 2);
  EXPECT_EQ(held.pitch, 0.25);
  const Matrix3 expected = makePose(Vector3::Zero(), {0, 0.25, 0.7}).linear();
  EXPECT_LT((held.orientation.toRotationMatrix() - expected).norm(), 1e-12);
}

/** Errors of a number, over all readings of a sensor that reads at 100 Hz. */
std::vector<double> errorsOf(SimulationConfig config, int which, std::size_t number, int readings) {
  config.robots[0].sensors[which].rate = 100;
  Simulator simulator(config, model::UriResolver());
  std::vector<double> errors;
  while (static_cast<int>(errors.size()) < readings) {
    const auto read = numbersOf(simulator.step(), which);
    if (!read.empty()) errors.push_back(read[number] - numbersOf(simulator.report(), which, true)[number]);
  }
  return errors;
}

double meanOf(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0) / values.size(); }

double deviationOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += (value - meanOf(values)) * (value - meanOf(values));
  return std::sqrt(sum / values.size());
}

/** A number of each quantity of the wrench, the tilt and the motors, by sensor. */
const std::vector<std::pair<int, std::array<std::size_t, 2>>> QUANTITIES = {{1, {0, 3}}, {2, {0, 2}}, {3, {0, 1}}};

constexpr int COUNT = SANITIZED ? 750 : 3000;  // of samples: statistics are as close as their number lets them

TEST(SensorNoise, OfEachQuantityHasItsDeviationAndBias) {
  for (const auto& [which, numbers] : QUANTITIES)
    for (const std::size_t quantity : {0u, 1u}) {
      SimulationConfig config = swingingScene();
      config.robots[0].sensors[which].noise = {};
      config.robots[0].sensors[which].noise[quantity].stddev = 0.5;
      config.robots[0].sensors[which].noise[quantity].bias = 3;
      const auto errors = errorsOf(config, which, numbers[quantity], COUNT), others = errorsOf(config, which, numbers[1 - quantity], 100);
      EXPECT_NEAR(meanOf(errors), 3, 3 * 0.5 / std::sqrt(COUNT)) << which << " " << quantity;
      EXPECT_NEAR(deviationOf(errors), 0.5, 3 * 0.5 / std::sqrt(2 * COUNT)) << which << " " << quantity;
      for (const double error : others) ASSERT_EQ(error, 0) << which << " " << quantity;
    }
}

TEST(SensorNoise, BiasIsDrawnOncePerNumberAndWalks) {
  for (const auto& [which, numbers] : QUANTITIES)
    for (const std::size_t quantity : {0u, 1u}) {
      SimulationConfig config = swingingScene();
      QuantityNoise& noise = config.robots[0].sensors[which].noise[quantity];
      config.robots[0].sensors[which].noise = {};
      noise.bias_spread = 2;
      const auto constant = errorsOf(config, which, numbers[quantity], 50);
      EXPECT_GT(std::abs(constant[0]), 1e-3);
      for (const double error : constant) EXPECT_NEAR(error, constant[0], 1e-12);
      noise.bias_stddev = 0.7;
      const auto walking = errorsOf(config, which, numbers[quantity], COUNT + 1);
      std::vector<double> ways;
      for (std::size_t i = 1; i < walking.size(); ++i) ways.push_back(walking[i] - walking[i - 1]);
      EXPECT_NEAR(deviationOf(ways), 0.07, 3 * 0.07 / std::sqrt(2 * COUNT)) << which << " " << quantity;
    }
}

TEST(SensorNoise, OfATiltTurnsItsOrientation) {
  SimulationConfig config = swingingScene();
  config.robots[0].X_WR = makePose({0, 0, 0}, {0, 0, 0.7});
  config.robots[0].sensors[2].noise[0].bias = 0.1;
  config.robots[0].sensors[2].noise[0].stddev = 1e-9;
  Simulator simulator(config, model::UriResolver());
  const TiltReading read = reading<TiltReading>(simulator.step(), 2);
  EXPECT_NEAR(read.roll, 0.1, 1e-8);
  EXPECT_EQ(read.angle_stddev, 1e-9);
  EXPECT_LT((read.orientation.toRotationMatrix() - makePose(Vector3::Zero(), {read.roll, read.pitch, 0.7}).linear()).norm(), 1e-9);
}

TEST(SensorNoise, IsSavedAndResetWithTheSensor) {
  SimulationConfig config = swingingScene();
  for (SensorConfig& sensor : config.robots[0].sensors)
    for (QuantityNoise& noise : sensor.noise) noise = {0.1, 0.2, 0.3, 0.4};
  Simulator straight(config, model::UriResolver()), restored(config, model::UriResolver());
  for (int i = 0; i < 20; ++i) straight.step();
  restored.restore(straight.save());
  ASSERT_EQ(restored.stateHash(), straight.stateHash());
  for (int i = 0; i < 20; ++i) {
    straight.step();
    restored.step();
    for (const int sensor : {0, 1, 2, 3}) ASSERT_EQ(numbersOf(restored.report(), sensor), numbersOf(straight.report(), sensor)) << i;
  }
  EXPECT_EQ(restored.stateHash(), straight.stateHash());
  straight.resetSimulation();
  Simulator fresh(config, model::UriResolver());
  for (const int sensor : {0, 1, 2, 3}) EXPECT_EQ(numbersOf(straight.step(), sensor).size(), numbersOf(fresh.step(), sensor).size());
  EXPECT_EQ(straight.stateHash(), fresh.stateHash());
}

TEST(SensorTruth, IsTheReadingWithoutErrors) {
  SimulationConfig config = swingingScene();
  std::vector<SensorConfig>& sensors = config.robots[0].sensors;
  for (SensorConfig& sensor : sensors) {
    sensor.noise = {};
    sensor.limits = {};
  }
  std::vector<std::vector<std::vector<double>>> exact;
  for (const int which : {0, 1, 2, 3}) exact.push_back(record(config, which));
  sensors[0].noise[0].stddev = sensors[0].noise[1].bias = 0.2;
  sensors[1].noise[0].stddev = sensors[2].noise[1].bias = sensors[3].noise[0].bias_spread = 1;
  for (SensorConfig& sensor : sensors) {
    sensor.delay = 0.005;
    sensor.limits = {QuantityLimits{2, 0.5}, QuantityLimits{2, 0.5}};
  }
  for (const int which : {0, 1, 2, 3}) {
    const auto truth = record(config, which, true), read = record(config, which);
    EXPECT_NE(read, truth);
    for (std::size_t i = 5; i < truth.size(); ++i) ASSERT_EQ(truth[i], exact[which][i]) << which << " " << i;
  }
}

TEST(SensorTruth, IsLeftOutOfSensorsWithoutErrors) {
  SimulationConfig config = swingingScene();
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  const std::vector<SensorSample>& samples = simulator.report().samples;
  ASSERT_EQ(samples.size(), 4u);
  for (const std::size_t i : {0u, 1u, 2u, 3u}) EXPECT_EQ(samples[i].truth.has_value(), i < 2) << i;
}

TEST(SensorErrors, ChangeNoOtherSensorAndNoMotion) {
  SimulationConfig config = swingingScene();
  const auto imu = record(config, 0), tilt = record(config, 2);
  config.robots[0].sensors[1].delay = 0.02;
  config.robots[0].sensors[1].limits = {QuantityLimits{5, 0.5}, QuantityLimits{5, 0.5}};
  EXPECT_EQ(record(config, 0), imu);
  EXPECT_EQ(record(config, 2), tilt);
}

}  // namespace
}  // namespace blem_sim::sim
