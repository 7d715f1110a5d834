// Save, restore, reset, hash; geometry that comes and goes.
#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"
#include "support/random/random_robot.h"

namespace blem_sim::sim {
namespace {

/** Cubes that tumble onto each other and a motor that works: something of every kind of state. */
SimulationConfig busyScene() {
  SimulationConfig config;
  config.environments = {ground()};
  for (int i = 0; i < 3; ++i) {
    config.objects.push_back(box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0.03 * i, 0, 0.1 + 0.12 * i}));
    config.objects.back().angular_velocity = {1, 2.0 * i, 3};
  }
  RobotConfig pendulum = robot("pendulum", pendulumUrdf(), true);
  pendulum.X_WR = makePose({1, 0, 0});
  pendulum.gains["default"] = {100, 10, 5, 50};
  SensorConfig imu;
  imu.name = "imu";
  imu.link = "arm";
  imu.noise[0].stddev = 0.1;
  imu.noise[0].bias_stddev = 0.1;
  pendulum.sensors = {imu};
  config.robots = {pendulum};
  return config;
}

TEST(SimulatorState, SameInputSameHash) {
  Simulator first(busyScene(), model::UriResolver()), second(busyScene(), model::UriResolver());
  EXPECT_EQ(first.stateHash(), second.stateHash());
  stepFor(&first, 0.5);
  const std::uint64_t middle = first.stateHash();
  stepFor(&second, 0.5);
  EXPECT_EQ(middle, second.stateHash());
  second.step();
  EXPECT_NE(middle, second.stateHash());
}

TEST(SimulatorState, RestoredInMidContactItReplaysBitForBit) {
  Simulator simulator(busyScene(), model::UriResolver());
  stepFor(&simulator, 0.25);
  ASSERT_FALSE(simulator.report().contacts.empty());
  const SimulationState saved = simulator.save();
  const std::uint64_t start = simulator.stateHash();
  stepFor(&simulator, 0.3);
  const std::uint64_t end = simulator.stateHash();
  const ImuReading noisy = reading<ImuReading>(simulator.report(), 0);

  simulator.restore(saved);
  EXPECT_EQ(simulator.stateHash(), start);
  EXPECT_EQ(simulator.steps(), 250u);
  stepFor(&simulator, 0.3);
  EXPECT_EQ(simulator.stateHash(), end);
  EXPECT_EQ(reading<ImuReading>(simulator.report(), 0).linear_acceleration, noisy.linear_acceleration);

  Simulator other(busyScene(), model::UriResolver());
  other.restore(saved);
  stepFor(&other, 0.3);
  EXPECT_EQ(other.stateHash(), end);
}

// Its bodies were shifted after they had been placed, and lost their last bits when they were placed anew.
TEST(SimulatorState, ARobotInFlightComesBackToTheSameBits) {
  SceneNumbers numbers(1);
  for (int robot = 0; robot < 8; ++robot) {
    SimulationConfig config;
    config.robots = {randomTree(&numbers, "thrown", {0, 0, 5}, 0.2).config};
    config.robots[0].fixed_base = false;
    Simulator simulator(config, model::UriResolver()), other(config, model::UriResolver());
    for (int i = 0; i < 50; ++i) {
      other.restore(simulator.save());
      simulator.step();
      other.step();
      ASSERT_EQ(other.stateHash(), simulator.stateHash()) << robot << " " << i;
    }
  }
}

// Models that came or went since the last step were not saved as the next step finds them.
TEST(SimulatorState, SavedWhereAModelCameOrWentItGoesOnByTheSameBits) {
  Simulator simulator(busyScene(), model::UriResolver());
  stepFor(&simulator, 0.05);
  const auto expectSame = [&](const char* when) {
    const SimulationState saved = simulator.save();
    stepFor(&simulator, 0.01);
    const std::uint64_t end = simulator.stateHash();
    simulator.restore(saved);
    stepFor(&simulator, 0.01);
    EXPECT_EQ(simulator.stateHash(), end) << when;
  };
  simulator.spawn(robot("visitor", pendulumUrdf(), true));
  expectSame("came");
  simulator.removeModel("visitor");
  expectSame("went");
}

TEST(SimulatorState, RefusesAStateOfOtherModels) {
  Simulator simulator(busyScene(), model::UriResolver());
  SimulationConfig fewer = busyScene();
  fewer.objects.pop_back();
  Simulator other(fewer, model::UriResolver());
  const std::uint64_t before = other.stateHash();
  EXPECT_THROW(other.restore(simulator.save()), InputError);
  EXPECT_EQ(other.stateHash(), before);
}

/** A state with any part missing at the end, of the dynamics' or of the rest, is refused, and nothing of it is taken. */
TEST(SimulatorState, RefusesAStateThatIsCutShort) {
  Simulator simulator(busyScene(), model::UriResolver()), other(busyScene(), model::UriResolver());
  stepFor(&simulator, 0.25);
  const SimulationState whole = simulator.save();
  const std::uint64_t untouched = other.stateHash();
  const auto expectRefused = [&](const SimulationState& cut) {
    EXPECT_THROW(other.restore(cut), InputError);
    EXPECT_EQ(other.stateHash(), untouched);
  };
  for (SimulationState cut = whole; !cut.numbers.empty();) {
    cut.numbers.pop_back();
    expectRefused(cut);
  }
  for (SimulationState cut = whole; !cut.words.empty();) {
    cut.words.pop_back();
    expectRefused(cut);
  }
  for (const std::size_t left : {std::size_t{0}, whole.world.numbers.size() / 2, whole.world.numbers.size() - 1}) {
    SimulationState cut = whole;
    cut.world.numbers.resize(left);
    expectRefused(cut);
  }
  SimulationState longer = whole;
  longer.numbers.push_back(0);
  expectRefused(longer);
  other.restore(whole);
  EXPECT_EQ(other.stateHash(), simulator.stateHash());
}

TEST(SimulatorState, ResetWorldKeepsTimeResetSimulationStartsAgain) {
  Simulator simulator(busyScene(), model::UriResolver());
  const std::uint64_t fresh = simulator.stateHash();
  stepFor(&simulator, 0.2);
  const std::uint64_t later = simulator.stateHash();
  simulator.commandJoints(0, {{"hinge"}, {0.5}, {}, {}});
  simulator.resetWorld();
  EXPECT_DOUBLE_EQ(simulator.time(), 0.2);
  EXPECT_LT((bodyOf(simulator, "cube2").X_WB.translation() - Vector3(0.06, 0, 0.34)).norm(), 1e-15);
  EXPECT_EQ(simulator.report().joints[0].velocity, 0);
  EXPECT_EQ(simulator.desiredState(0, 0).position, 0);
  simulator.resetSimulation();
  EXPECT_EQ(simulator.time(), 0);
  EXPECT_EQ(simulator.stateHash(), fresh);
  stepFor(&simulator, 0.2);
  EXPECT_EQ(simulator.stateHash(), later);
}

TEST(SimulatorState, EnvironmentsComeAndGoUnderABox) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.0525})};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.1);
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), 0.0525, 2e-6);

  EnvironmentConfig lower = ground();
  lower.name = "lower";
  lower.X_WE = makePose({0, 0, -0.2});
  simulator.loadEnvironment(lower);
  EXPECT_THROW(simulator.loadEnvironment(lower), InputError);
  simulator.unloadEnvironment("ground");
  EXPECT_THROW(simulator.unloadEnvironment("ground"), InputError);
  EXPECT_EQ(simulator.modelIndex("ground"), -1);
  EXPECT_EQ(simulator.loadReport().size(), 2u);
  stepFor(&simulator, 0.1);
  EXPECT_LT(bodyOf(simulator, "cube").X_WB.translation().z(), 0.03);
  stepFor(&simulator, 0.5);
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), -0.1475, 2e-6);
}

TEST(SimulatorState, AnUnreadableEnvironmentChangesNothing) {
  SimulationConfig config;
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.0525})};
  Simulator simulator(config, model::UriResolver());
  EnvironmentConfig missing;
  missing.name = "missing";
  missing.uri = "there_is_no_such_file.stl";
  EXPECT_THROW(simulator.loadEnvironment(missing), InputError);
  EXPECT_EQ(simulator.models().size(), 1u);
  EXPECT_EQ(simulator.colliders().size(), 1u);
}

}  // namespace
}  // namespace blem_sim::sim
