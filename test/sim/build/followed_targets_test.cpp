// Real robots as their URDFs alone describe them: each motor takes its joint where it is told to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/simulation_scene.h"
#include "support/sanitizers.h"
#include "support/shared_packages.h"

namespace blem_sim::sim {
namespace {

constexpr double ENDLESS = 100;                 // [rad or m] range of a joint without limits worth the name
constexpr double OFF = 1.05e-3, SLIDES = 1e-4;  // [rad] most that friction keeps a hinge off, [m] a slider

class FollowedTargets : public testing::TestWithParam<const char*> {};

/** Commands each driven joint to a share of its range. @return targets, by index into joint_names; NaN: not driven */
std::vector<double> commandShare(double share, Simulator* simulator) {
  const RobotInfo& robot = simulator->robots()[0];
  std::vector<double> targets(robot.joint_names.size(), NAN);
  JointCommandMessage command;
  for (std::size_t j = 0; j < targets.size(); ++j) {
    const model::JointLimits& limits = robot.limits[j];
    if (!robot.driven[j]) continue;
    const bool ends = limits.upper - limits.lower < ENDLESS;
    targets[j] = ends ? limits.lower + share * (limits.upper - limits.lower) : 2 * share - 1;
    command.joints.push_back(robot.joint_names[j]);
    command.positions.push_back(targets[j]);
  }
  simulator->commandJoints(0, command);
  return targets;
}

// Links may pass through each other, and nothing weighs: friction alone is in the way.
TEST_P(FollowedTargets, AreReached) {
  const auto file = sharedData(std::string("robots/") + GetParam());
  if (!file) GTEST_SKIP() << "shared data not found";
  SimulationConfig config;
  config.gravity.setZero();
  config.robots = {robot("robot", "", true)};
  config.robots[0].urdf = *file;
  config.robots[0].motors = MotorDefault::COMPUTED;
  config.robots[0].self_collision = false;
  Simulator simulator(config, model::UriResolver(sharedPackages()));
  const RobotInfo robot = simulator.robots()[0];
  for (const double share : SANITIZED ? std::vector<double>{0.9} : std::vector<double>{0.1, 0.9}) {
    const std::vector<double> targets = commandShare(share, &simulator);
    stepFor(&simulator, SANITIZED ? 2 : 4);  // the slowest is there after 1.8 s
    for (std::size_t j = 0; j < targets.size(); ++j) {
      const bool slides = simulator.world().jointSpec(robot.joints[j]).kind == dynamics::JointKind::PRISMATIC;
      if (std::isnan(targets[j])) continue;
      EXPECT_NEAR(simulator.report().joints[robot.joints[j]].position, targets[j], slides ? SLIDES : OFF) << robot.joint_names[j];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, FollowedTargets,
                         testing::Values("example-robot-data/robots/panda_description/urdf/panda.urdf",
                                         "example-robot-data/robots/ur_description/urdf/ur5_robot.urdf",
                                         "example-robot-data/robots/anymal_c_simple_description/urdf/anymal.urdf",
                                         "robotiq_arg85_description/robots/robotiq_arg85_description.urdf",
                                         "klampt/pr2gripper/pr2gripper.urdf", "klampt/tx90l/tx90l.urdf", "klampt/tx90pr2/tx90pr2.urdf",
                                         "klampt/atlas/atlas.urdf", "klampt/huboplus/huboplus.urdf"));

}  // namespace
}  // namespace blem_sim::sim
