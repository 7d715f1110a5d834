// Odometry of a link: pose, velocities in either axes, noise; constant biases of an IMU.
#include <cmath>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

/** A pendulum that swings freely, with these sensors. */
SimulationConfig swinging(const std::vector<SensorConfig>& sensors) {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  config.robots[0].X_WR = makePose({1, 2, 3}, {0, 0, M_PI / 2});
  config.robots[0].sensors = sensors;
  return config;
}

SensorConfig odometry(const std::string& twist, double stddev = 0) {
  SensorConfig config;
  config.name = twist;
  config.type = SensorType::ODOMETRY;
  config.link = "arm";
  config.twist = twist;
  config.X_LS = makePose({1, 0, 0});
  config.noise[0].stddev = stddev;
  return config;
}

TEST(OdometrySensor, OffsetShiftsThePositionAndTurnsTheOrientation) {
  SensorConfig shifted = odometry("world");
  shifted.name = "shifted";
  shifted.X_offset = makePose({1, -2, 3}, {0.1, 0.2, 0.3});
  Simulator simulator(swinging({odometry("world"), shifted}), model::UriResolver());
  stepFor(&simulator, 0.2);
  const OdometryReading plain = reading<OdometryReading>(simulator.report(), 0), told = reading<OdometryReading>(simulator.report(), 1);
  EXPECT_LT((told.position - plain.position - Vector3(1, -2, 3)).norm(), 1e-12);
  const Quaternion turned = Quaternion(shifted.X_offset.linear()) * plain.orientation;
  EXPECT_LT(told.orientation.angularDistance(turned), 1e-7);
  EXPECT_EQ(told.linear_velocity, plain.linear_velocity);
  EXPECT_EQ(told.angular_velocity, plain.angular_velocity);
}

TEST(OdometrySensor, PoseAndVelocitiesOfATurningArm) {
  Simulator simulator(swinging({odometry("link"), odometry("world")}), model::UriResolver());
  stepFor(&simulator, 0.2);
  const RobotInfo& info = simulator.robots()[0];
  const dynamics::JointState joint = simulator.report().joints[info.joints[0]];
  const OdometryReading link = reading<OdometryReading>(simulator.report(), 0), world = reading<OdometryReading>(simulator.report(), 1);
  const double q = joint.position, w = joint.velocity;
  ASSERT_GT(w, 1);
  // The hinge turns about the world's -x; the arm points along y, and down by q.
  const Vector3 along(0, std::cos(q), -std::sin(q)), down(0, -std::sin(q), -std::cos(q));
  EXPECT_LT((world.position - (Vector3(1, 2, 4) + along)).norm(), 1e-9);
  EXPECT_LT((world.orientation * Vector3::UnitX() - along).norm(), 1e-9);
  EXPECT_LT((world.linear_velocity - w * down).norm(), 1e-9);
  EXPECT_LT((world.angular_velocity - Vector3(-w, 0, 0)).norm(), 1e-9);
  EXPECT_LT((link.linear_velocity - Vector3(0, 0, -w)).norm(), 1e-9);
  EXPECT_LT((link.angular_velocity - Vector3(0, w, 0)).norm(), 1e-9);
  EXPECT_EQ(link.position, world.position);
}

TEST(OdometrySensor, NoiseHasItsDeviation) {
  SimulationConfig config = swinging({odometry("world"), odometry("link", 0.02)});
  Simulator simulator(config, model::UriResolver());
  double squares = 0, turns = 0;
  constexpr int STEPS = 3000;
  for (int i = 0; i < STEPS; ++i) {
    simulator.step();
    const OdometryReading truth = reading<OdometryReading>(simulator.report(), 0), noisy = reading<OdometryReading>(simulator.report(), 1);
    squares += (noisy.position - truth.position).squaredNorm() / (3 * STEPS);
    turns += std::pow(noisy.orientation.angularDistance(truth.orientation), 2) / (3 * STEPS);
  }
  EXPECT_NEAR(std::sqrt(squares), 0.02, 0.001);
  EXPECT_NEAR(std::sqrt(turns), 0.02, 0.001);
}

TEST(ImuSensor, ConstantBiasesAreDrawnOnceAndReplayed) {
  SensorConfig exact, biased;
  exact.name = "exact";
  exact.type = SensorType::IMU;
  exact.link = "arm";
  biased = exact;
  biased.name = "biased";
  biased.noise[0].bias = 0.5;
  biased.noise[1].bias = -0.25;
  biased.noise[1].bias_spread = 0.01;
  Simulator simulator(swinging({exact, biased}), model::UriResolver());
  const auto error = [&](bool gyro) {
    const ImuReading truth = reading<ImuReading>(simulator.report(), 0), imu = reading<ImuReading>(simulator.report(), 1);
    return Vector3(gyro ? imu.angular_velocity - truth.angular_velocity : imu.linear_acceleration - truth.linear_acceleration);
  };
  const SimulationState start = simulator.save();
  simulator.step();
  const Vector3 gyro = error(true);
  EXPECT_LT((error(false) - Vector3::Constant(0.5)).norm(), 1e-12);
  EXPECT_LT((gyro - Vector3::Constant(-0.25)).norm(), 0.07);
  EXPECT_GT((gyro - Vector3::Constant(-0.25)).norm(), 1e-4);
  const SimulationState later = simulator.save();
  stepFor(&simulator, 0.1);
  EXPECT_LT((error(true) - gyro).norm(), 1e-12);
  const std::uint64_t hash = simulator.stateHash();
  for (const SimulationState* state : {&later, &start}) {
    simulator.restore(*state);
    while (simulator.steps() < 101) simulator.step();
    EXPECT_EQ(simulator.stateHash(), hash);
    EXPECT_LT((error(true) - gyro).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace blem_sim::sim
