// Robots that tumble onto a scan, links against links and against the ground, held by their motors, and limp. What moves in them is paid
// for.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "blem_sim/sim/simulator.h"
#include "soak/figures.h"
#include "support/shared_packages.h"

namespace blem_sim {
namespace {

const char* const STAIRS = "scans/real/stairroom_scene.ply";

struct Fall {
  const char* name;
  const char* urdf;  ///< below the shared robots
  sim::MotorDefault motors;
  int told;  ///< most steps that may say ENERGY_GAINED
};

const char* const UR5 = "robots/example-robot-data/robots/ur_description/urdf/ur5_robot.urdf";
const char* const TX90L = "robots/klampt/tx90l/tx90l.urdf";
const char* const PANDA = "robots/example-robot-data/robots/panda_description/urdf/panda.urdf";

const Fall FALLS[] = {{"UR5, held", UR5, sim::MotorDefault::COMPUTED, 2},     {"UR5, limp", UR5, sim::MotorDefault::FREE, 2},
                      {"TX90L, held", TX90L, sim::MotorDefault::COMPUTED, 2}, {"TX90L, limp", TX90L, sim::MotorDefault::FREE, 2},
                      {"Panda, held", PANDA, sim::MotorDefault::COMPUTED, 2}, {"Panda, limp", PANDA, sim::MotorDefault::FREE, 5}};

sim::SimulationConfig falling(const Fall& fall, const Vector3& rpy) {
  sim::SimulationConfig config;
  config.solver = soakSettings();
  sim::EnvironmentConfig ground, stairs;
  ground.name = "ground";
  ground.plane = Eigen::Vector4d(0, 0, 1, -0.3);
  stairs.name = "stairs";
  stairs.uri = *sharedData(STAIRS);
  config.environments = {ground, stairs};
  config.robots.resize(1);
  config.robots[0].name = "robot";
  config.robots[0].urdf = *sharedData(fall.urdf);
  config.robots[0].self_collision = true;
  config.robots[0].motors = fall.motors;
  config.robots[0].X_WR = makePose({2.2, 0.2, 1.6}, rpy);
  return config;
}

class FallingRobot : public ::testing::TestWithParam<Fall> {};

TEST_P(FallingRobot, GainsNothing) {
  const Fall& fall = GetParam();
  SKIP_WITHOUT_SHARED_DATA(fall.urdf);
  double most = 0, all = 0;
  int told = 0, steps = 0;
  for (const Vector3& rpy : {Vector3(-2.3, 2.1, 1.6), Vector3(0.4, 1.1, -2.5), Vector3(1.9, -0.7, 0.3)}) {
    sim::Simulator simulator(falling(fall, rpy), model::UriResolver(sharedPackages()));
    for (int i = 0; i < soakSteps(2, 1); ++i, ++steps) {
      const sim::StepReport& report = simulator.step();
      ASSERT_FALSE(report.status & sim::STATE_NOT_FINITE) << rpy.transpose() << ", step " << i;
      most = std::max(most, report.energy_out_of_nothing);
      all += report.energy_out_of_nothing;
      told += (report.status & sim::ENERGY_GAINED) != 0;
    }
    for (const dynamics::BodyState& body : simulator.report().bodies) EXPECT_GT(body.X_WB.translation().z(), -0.4) << rpy.transpose();
  }
  const std::string name = fall.name;
  figure(name + ": out of nothing in a step", most, "J");
  figure(name + ": in all, three falls", all, "J");
  figure(name + ": steps that said ENERGY_GAINED", told, "");
  EXPECT_LE(told, fall.told) << "of " << steps;
}

INSTANTIATE_TEST_SUITE_P(Robots, FallingRobot, ::testing::ValuesIn(FALLS));

}  // namespace
}  // namespace blem_sim
