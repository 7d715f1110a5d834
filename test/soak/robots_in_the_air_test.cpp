// Robots on fixed bases that touch nothing: thrown about by their motors, and limp. What moves in them is paid for.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "blem_sim/sim/simulator.h"
#include "soak/figures.h"
#include "support/shared_packages.h"

namespace blem_sim {
namespace {

struct Hung {
  const char* name;
  const char* urdf;  ///< below the shared robots
};

const Hung HUNG[] = {{"TX90L", "klampt/tx90l/tx90l.urdf"},
                     {"Hubo", "klampt/huboplus/huboplus.urdf"},
                     {"Atlas", "klampt/atlas/atlas.urdf"},
                     {"Panda", "example-robot-data/robots/panda_description/urdf/panda.urdf"},
                     {"ANYmal", "example-robot-data/robots/anymal_c_simple_description/urdf/anymal.urdf"},
                     {"UR5", "example-robot-data/robots/ur_description/urdf/ur5_robot.urdf"}};

sim::SimulationConfig hung(const Hung& robot, sim::MotorDefault motors) {
  sim::SimulationConfig config;
  config.solver = soakSettings();
  config.robots.resize(1);
  config.robots[0].name = "robot";
  config.robots[0].urdf = *sharedData(std::string("robots/") + robot.urdf);
  config.robots[0].fixed_base = true;
  config.robots[0].motors = motors;
  config.robots[0].X_WR = makePose({0, 0, 1.2}, {0.2, 0.3, 0});
  return config;
}

/** Steps a robot and states what came out of nothing. @param each called before each step, with its number @return steps that said so */
template <typename Each>
int run(const std::string& name, sim::Simulator* simulator, const Each& each) {
  double most = 0, all = 0;
  int told = 0;
  for (int i = 0; i < soakSteps(3, 3); ++i) {
    each(i);
    const sim::StepReport& report = simulator->step();
    most = std::max(most, report.energy_out_of_nothing);
    all += report.energy_out_of_nothing;
    told += (report.status & sim::ENERGY_GAINED) != 0;
  }
  figure(name + ": out of nothing in a step", most, "J");
  figure(name + ": in all", all, "J");
  figure(name + ": steps that said ENERGY_GAINED", told, "");
  return told;
}

class RobotInTheAir : public ::testing::TestWithParam<Hung> {};

TEST_P(RobotInTheAir, IsThrownAboutByItsMotors) {
  SKIP_WITHOUT_SHARED_DATA(std::string("robots/") + GetParam().urdf);
  sim::Simulator simulator(hung(GetParam(), sim::MotorDefault::COMPUTED), model::UriResolver(sharedPackages()));
  const std::vector<std::string> joints = simulator.robots()[0].joint_names;
  std::mt19937 random(1);
  std::vector<double> targets(joints.size());
  const int told = run(std::string(GetParam().name) + ", thrown about", &simulator, [&](int step) {
    if (step % 150 != 0) return;
    for (double& target : targets) target = 2 * static_cast<double>(random()) / 0x1p32 - 1;
    simulator.commandJoints(0, {joints, targets, {}, {}});
  });
  EXPECT_LE(told, 30);
}

TEST_P(RobotInTheAir, HangsLimp) {
  SKIP_WITHOUT_SHARED_DATA(std::string("robots/") + GetParam().urdf);
  sim::Simulator simulator(hung(GetParam(), sim::MotorDefault::FREE), model::UriResolver(sharedPackages()));
  EXPECT_EQ(run(std::string(GetParam().name) + ", limp", &simulator, [](int) {}), 0);
}

INSTANTIATE_TEST_SUITE_P(Robots, RobotInTheAir, ::testing::ValuesIn(HUNG));

}  // namespace
}  // namespace blem_sim
