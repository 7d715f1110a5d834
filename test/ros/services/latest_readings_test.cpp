// What is kept for a learner's next answer: readings until their sensor's next one, status bits until they are taken.
#include "services/door/latest_readings.h"

#include "sim/simulation_scene.h"

namespace blem_sim::node {
namespace {

sim::RobotConfig pendulumWithTilt(const std::string& name, double rate) {
  sim::RobotConfig config = sim::robot(name, sim::pendulumUrdf(), true);
  sim::SensorConfig tilt;
  tilt.name = "tilt", tilt.type = sim::SensorType::TILT, tilt.link = "arm", tilt.rate = rate;
  config.sensors = {tilt};
  return config;
}

class LatestReadingsTest : public ::testing::Test {
 protected:
  LatestReadingsTest() : simulator_(twoPendulums(), model::UriResolver()), readings_(simulator_) {}

  static sim::SimulationConfig twoPendulums() {
    sim::SimulationConfig config;
    config.robots = {pendulumWithTilt("fast", 0), pendulumWithTilt("slow", 100)};
    return config;
  }
  void step(int count) {
    for (int i = 0; i < count; ++i) readings_.publish(simulator_.step());
  }
  double timeOf(int sensor) const {
    const LatestReadings::Reading* reading = readings_.of(simulator_.sensors()[static_cast<std::size_t>(sensor)]);
    return reading ? reading->time : -1;
  }

  sim::Simulator simulator_;
  LatestReadings readings_;
};

TEST_F(LatestReadingsTest, NothingIsKeptUntilSomebodyAsks) {
  step(20);
  EXPECT_EQ(timeOf(0), -1);
  readings_.keep();
  EXPECT_NEAR(timeOf(0), 0.020, 1e-12) << "readings of the step at hand are there at once";
}

TEST_F(LatestReadingsTest, EachIsKeptUntilTheNext) {
  readings_.keep();
  step(25);
  EXPECT_NEAR(timeOf(0), 0.025, 1e-12);
  EXPECT_NEAR(timeOf(1), 0.020, 1e-12);
}

TEST_F(LatestReadingsTest, OthersGoWithTheirRobots) {
  readings_.keep();
  step(25);
  simulator_.removeModel("fast");
  readings_.modelsChanged();
  EXPECT_NEAR(timeOf(0), 0.020, 1e-12) << "the slow one's, now the first";
  simulator_.spawn(pendulumWithTilt("fast", 0));
  readings_.modelsChanged();
  EXPECT_NEAR(timeOf(0), 0.020, 1e-12);
  EXPECT_EQ(timeOf(1), -1) << "a robot of the same name begins anew";
}

TEST_F(LatestReadingsTest, NoneIsLeftWhenTimeRestarts) {
  readings_.keep();
  step(25);
  readings_.timeRestarted();
  EXPECT_EQ(timeOf(0), -1);
}

TEST_F(LatestReadingsTest, StatusHasTheBitsOfAllStepsSinceItWasTaken) {
  readings_.keep();
  readings_.takeStatus();
  sim::StepReport report;
  for (const std::uint32_t bits : {sim::JOINT_LIMIT_HIT, sim::EFFORT_SATURATED, sim::STEP_OK}) {
    report.status = bits;
    readings_.publish(report);
  }
  EXPECT_EQ(readings_.takeStatus(), std::uint32_t{sim::JOINT_LIMIT_HIT | sim::EFFORT_SATURATED});
  EXPECT_EQ(readings_.takeStatus(), std::uint32_t{sim::STEP_OK});
}

}  // namespace
}  // namespace blem_sim::node
