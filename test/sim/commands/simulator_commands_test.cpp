#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

SimulationConfig pendulumScene() {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  config.robots[0].gains["default"] = {1e5, 0, 1e3};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  config.gravity = Vector3::Zero();
  return config;
}

JointTrajectory reach(double position, double time, double start = 0) {
  JointTrajectory trajectory;
  trajectory.joints = {"hinge"};
  trajectory.start_time = start;
  trajectory.points = {{time, {position}, {0.0}, {0.0}, {}}};
  return trajectory;
}

template <typename Act>
std::string refusalOfAct(const Act& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SimulatorCommands, TrajectoryIsFollowed) {
  Simulator simulator(pendulumScene(), model::UriResolver());
  stepFor(&simulator, 0.1);
  simulator.commandTrajectory(0, reach(1, 1));
  EXPECT_NEAR(simulator.desiredState(0, 0).position, 0, 1e-12);
  stepFor(&simulator, 0.5);
  EXPECT_NEAR(simulator.desiredState(0, 0).position, 0.5, 0.02);
  EXPECT_NEAR(simulator.report().joints[0].position, simulator.desiredState(0, 0).position, 1e-3);
  stepFor(&simulator, 1);
  EXPECT_NEAR(simulator.desiredState(0, 0).position, 1, 1e-12);
  EXPECT_NEAR(simulator.report().joints[0].position, 1, 1e-6);
}

TEST(SimulatorCommands, ANewTrajectoryTakesOverAtItsStart) {
  Simulator simulator(pendulumScene(), model::UriResolver());
  simulator.commandTrajectory(0, reach(1, 1));
  simulator.commandTrajectory(0, reach(-1, 1, 2.0));
  stepFor(&simulator, 1.5);
  EXPECT_NEAR(simulator.report().joints[0].position, 1, 1e-4);
  stepFor(&simulator, 1.8);
  EXPECT_NEAR(simulator.report().joints[0].position, -1, 1e-4);
}

TEST(SimulatorCommands, NoPointsIsHold) {
  Simulator simulator(pendulumScene(), model::UriResolver());
  simulator.commandTrajectory(0, reach(1, 1));
  stepFor(&simulator, 0.5);
  simulator.commandTrajectory(0, {});
  const double held = simulator.desiredState(0, 0).position;
  stepFor(&simulator, 0.5);
  EXPECT_EQ(simulator.desiredState(0, 0).position, held);
  EXPECT_NEAR(simulator.report().joints[0].position, held, 1e-4);
}

TEST(SimulatorCommands, JointTargets) {
  Simulator simulator(pendulumScene(), model::UriResolver());
  simulator.commandJoints(0, {{"hinge"}, {0.3}, {}, {}});
  stepFor(&simulator, 1);
  EXPECT_NEAR(simulator.report().joints[0].position, 0.3, 1e-6);
  simulator.commandJoints(0, {{"hinge"}, {}, {0.5}, {}});
  stepFor(&simulator, 1);
  EXPECT_NEAR(simulator.report().joints[0].velocity, 0.5, 1e-6);
  EXPECT_NEAR(simulator.report().joints[0].position, 0.8, 1e-2);
  simulator.commandJoints(0, {{"hinge"}, {0}, {}, {100}});
  stepFor(&simulator, 1);
  // The effort adds: it bends the hold by effort / stiffness.
  EXPECT_NEAR(simulator.report().joints[0].position, 100 / 1e5, 1e-6);
}

SimulationConfig wheelScene(MotorLaw law, const JointGains& gains) {
  SimulationConfig config = pendulumScene();
  std::string& urdf = config.robots[0].urdf_xml;
  urdf.replace(urdf.find("revolute"), 8, "continuous");
  config.robots[0].gains["default"] = gains;
  config.robots[0].motor["default"] = law;
  return config;
}

// An arm held against its weight has an integral; a velocity that follows is reached as d (v* - v) alone reaches it.
TEST(SimulatorCommands, VelocityIsReachedAfterAnIntegralHasBuiltUp) {
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    SimulationConfig config = wheelScene(law, {1000, 2000, 60, 1000});
    config.gravity = {0, 0, 0};
    Simulator simulator(config, model::UriResolver());
    simulator.commandJoints(0, {{"hinge"}, {0}, {}, {-20}});
    stepFor(&simulator, 5);
    EXPECT_NEAR(simulator.report().joints[0].position, 0, 1e-3);
    simulator.commandJoints(0, {{"hinge"}, {}, {0.5}, {0}});
    stepFor(&simulator, 1);
    EXPECT_NEAR(simulator.report().joints[0].velocity, 0.5, 1e-6);
  }
}

TEST(SimulatorCommands, AJointWithoutEndTakesTheNearestTurn) {
  Simulator simulator(wheelScene(MotorLaw::IMPLICIT_PD, {1000, 0, 60}), model::UriResolver());
  const auto turned = [&](double turns, double rest) {
    simulator.commandJoints(0, {{"hinge"}, {2 * M_PI * turns + rest}, {}, {}});
    double fastest = 0;
    for (int i = 0; i < 1000; ++i) {
      simulator.step();
      fastest = std::max(fastest, std::abs(simulator.report().joints[0].velocity));
    }
    EXPECT_LT(fastest, 50);
    EXPECT_FALSE(simulator.report().status & STATE_NOT_FINITE);
    return simulator.report().joints[0].position;
  };
  EXPECT_NEAR(turned(1e6, 0.3), 0.3, 1e-6);
  EXPECT_NEAR(turned(-3, -0.5), -0.5, 1e-6);
  EXPECT_NEAR(turned(0, 2), 2, 1e-6);
  EXPECT_NEAR(turned(0, -2), 2 * M_PI - 2, 1e-6);  // on over pi, not back
  EXPECT_NEAR(turned(-7, 0), 2 * M_PI, 1e-6);
}

// Commands that are not refused leave the simulation running.
TEST(SimulatorCommands, WhatIsTooLargeIsRefused) {
  const auto expectRefused = [](const std::string& urdf_joint, double target) {
    SimulationConfig config = pendulumScene();
    std::string& urdf = config.robots[0].urdf_xml;
    urdf.replace(urdf.find("revolute"), 8, urdf_joint);
    Simulator simulator(config, model::UriResolver());
    const std::uint64_t before = simulator.stateHash();
    for (const double bad : {1e308, -1e308, 1.01e7}) {
      for (const JointCommandMessage& command :
           {JointCommandMessage{{"hinge"}, {bad}, {}, {}}, {{"hinge"}, {}, {bad}, {}}, {{"hinge"}, {}, {}, {bad}}}) {
        const std::string message = refusalOfAct([&] { simulator.commandJoints(0, command); });
        EXPECT_NE(message.find("beyond 1e+07"), std::string::npos) << message;
      }
      EXPECT_NE(refusalOfAct([&] { simulator.commandTrajectory(0, reach(bad, 1)); }), "");
    }
    EXPECT_EQ(simulator.stateHash(), before);
    simulator.commandJoints(0, {{"hinge"}, {target}, {}, {}});
    stepFor(&simulator, 0.1);
    EXPECT_FALSE(simulator.report().status & STATE_NOT_FINITE);
    EXPECT_EQ(simulator.steps(), 100u);
  };
  for (const double target : {9.9e6, -9.9e6}) {
    expectRefused("revolute", target);
    expectRefused("continuous", target);
    expectRefused("prismatic", target);
  }
}

TEST(SimulatorCommands, ErrorsNameRobotAndJointAndChangeNothing) {
  Simulator simulator(pendulumScene(), model::UriResolver());
  const std::uint64_t before = simulator.stateHash();
  const double nan = std::nan("");
  const auto expectRefused = [&](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find("pendulum"), std::string::npos) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  JointTrajectory unknown = reach(1, 1);
  unknown.joints = {"hindge"};
  expectRefused(refusalOfAct([&] { simulator.commandTrajectory(0, unknown); }), "'hinge'");
  expectRefused(refusalOfAct([&] { simulator.commandTrajectory(0, reach(nan, 1)); }), "hinge");
  expectRefused(refusalOfAct([&] { simulator.commandJoints(0, {{"hing"}, {1}, {}, {}}); }), "'hinge'");
  expectRefused(refusalOfAct([&] { simulator.commandJoints(0, {{"hinge"}, {}, {nan}, {}}); }), "'hinge'");
  expectRefused(refusalOfAct([&] { simulator.commandJoints(0, {{"hinge"}, {1, 2}, {}, {}}); }), "2 values for 1");
  expectRefused(refusalOfAct([&] { simulator.commandJoints(0, {{"hinge", "hinge"}, {1, 2}, {}, {}}); }), "twice");
  EXPECT_EQ(simulator.stateHash(), before);
}

}  // namespace
}  // namespace blem_sim::sim
