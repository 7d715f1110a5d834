// Properties that are changed while a simulation runs hold everywhere from then on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "blem_sim/sim/named_parts.h"
#include "sim/simulation_scene.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

constexpr double ARM_INERTIA = 0.02 + 2 * 0.25, ARM_WEIGHT = 2 * 0.5 * G;

SimulationConfig freeArm(const std::string& stepper = "articulated") {
  SimulationConfig config;
  config.solver.stepper = stepper;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  return config;
}

double armAngle(const Simulator& simulator) { return simulator.report().joints[0].position; }

TEST(LiveProperties, ConfigurationsAreMovedIntoTheLimitsThatHold) {
  Simulator simulator(freeArm(), model::UriResolver());
  simulator.setJointLimits(0, 0, -0.2, 0.4);
  simulator.setJointPositions(0, {"hinge"}, {1});
  EXPECT_DOUBLE_EQ(armAngle(simulator), 0.4);
  simulator.setJointLimits(0, 0, -4, 4);
  simulator.setJointPositions(0, {"hinge"}, {-3.5});
  EXPECT_DOUBLE_EQ(armAngle(simulator), -3.5);
}

/** A joint that rests on a limit stands beyond it by some 1e-12 rad: the limit may be set again, and when it goes the joint falls. */
TEST(LiveProperties, LimitsThatAJointRestsOnMaySetTheOther) {
  for (const char* stepper : {"articulated", "world_step"}) {
    Simulator simulator(freeArm(stepper), model::UriResolver());
    simulator.setJointLimits(0, 0, -3, 0.5);
    stepFor(&simulator, 2);
    EXPECT_NEAR(armAngle(simulator), 0.5, 1e-9) << stepper;
    EXPECT_EQ(refusal([&] { simulator.setJointLimits(0, 0, -2, 0.5); }), "") << stepper;
    EXPECT_NE(refusal([&] { simulator.setJointLimits(0, 0, -2, 0.49); }), "") << stepper;
    simulator.setJointLimits(0, 0, -2, 1);
    const double acceleration = simulator.step().joints[0].velocity / simulator.config().time_step;
    EXPECT_NEAR(acceleration, ARM_WEIGHT * std::cos(0.5) / ARM_INERTIA, 1e-4) << stepper;
  }
}

TEST(LiveProperties, ResetsStayWithinTheLimitsThatHold) {
  SimulationConfig config = freeArm();
  config.gravity = Vector3::Zero();
  Simulator simulator(config, model::UriResolver());
  simulator.setJointPositions(0, {"hinge"}, {0.5});
  simulator.setJointLimits(0, 0, 0.3, 1);
  for (const bool all : {true, false}) {
    all ? simulator.resetWorld() : simulator.resetModel(0);
    EXPECT_DOUBLE_EQ(armAngle(simulator), 0.3);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(simulator.step().status & ENERGY_GAINED, 0u);
    EXPECT_NEAR(armAngle(simulator), 0.3, 1e-9);
  }
}

TEST(LiveProperties, VelocityLimitsHoldForLinksThatWereMadeLighter) {
  constexpr double LIMIT = 10, LIGHTER = 1e-4;
  SimulationConfig config = freeArm();
  config.gravity = Vector3::Zero();
  config.robots[0].gains["default"] = {0, 0, 0};
  Simulator simulator(config, model::UriResolver());
  const LinkPart arm = findLink(simulator, "pendulum::arm", "test");
  geometry::MassProperties inertial = simulator.linkInertial(arm.body, arm.link);
  inertial.mass *= LIGHTER;
  inertial.inertia *= LIGHTER;
  simulator.setLinkInertial(arm.body, arm.link, inertial);
  simulator.commandJoints(0, {{"hinge"}, {}, {}, {3}});
  double fastest = 0;
  for (int i = 0; i < 200; ++i) fastest = std::max(fastest, std::abs(simulator.step().joints[0].velocity));
  EXPECT_NEAR(fastest, LIMIT, 1e-4);
}

/** A robot that came while gravity was off, as for spawning and posing in peace: it sags by weight over gain, 1 mrad. */
TEST(LiveProperties, ComputedGainsHoldWhenGravityComesBack) {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  Simulator simulator(config, model::UriResolver());
  RobotConfig robot = freeArm().robots[0];
  robot.motors = MotorDefault::COMPUTED;
  robot.motor.clear();
  simulator.spawn(robot);
  simulator.setPhysics({0, 0, -G}, config.time_step, 1);
  stepFor(&simulator, 2);
  EXPECT_NEAR(armAngle(simulator), 1e-3, 1e-8);
}

TEST(LiveProperties, LayersAreChosenForTheTimeStepAtHand) {
  constexpr double TIME_STEP = 0.004;
  const SimulationConfig config;
  Simulator simulator(config, model::UriResolver());
  simulator.setPhysics(simulator.gravity(), TIME_STEP, 1);
  RobotConfig cube;
  cube.name = "cube";
  cube.urdf_xml =
      R"(<robot name="cube"><link name="link"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>)"
      R"(</inertial><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link></robot>)";
  cube.contact.boundary_width = BoundaryWidth::chosen();
  simulator.spawn(cube);
  EXPECT_NEAR(simulator.colliders().at(0).radius, TIME_STEP, 1e-12);  // the way of 1 m/s
}

}  // namespace
}  // namespace blem_sim::sim
