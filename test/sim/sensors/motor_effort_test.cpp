// Efforts and currents are the motor's alone: friction, mimic joints and efforts from outside are not in them.
#include <cmath>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double STICTION = 25;  // [N m]

/** A bar of 0.1 kg m^2 about the vertical axis of a post, with a motor of 20 N m/rad. */
SimulationConfig stickyBar(const char* stepper, MotorLaw law) {
  SimulationConfig config;
  config.solver.stepper = stepper;
  config.robots = {robot("bar", R"(<robot name="bar"><link name="post"/>
    <link name="bar"><inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="hinge" type="continuous"><parent link="post"/><child link="bar"/><axis xyz="0 0 1"/></joint></robot>)",
                         true)};
  RobotConfig& bar = config.robots[0];
  bar.gains["default"] = {20, 0, 1};
  bar.motor["default"] = law;
  bar.joint_friction["default"] = {STICTION, 0};
  SensorConfig motors;
  motors.name = "motors", motors.type = SensorType::MOTOR_CURRENT;
  motors.torque_constant = {{"default", 0.5}};
  bar.sensors = {motors};
  return config;
}

class MotorEffort : public ::testing::TestWithParam<std::tuple<const char*, MotorLaw>> {};

TEST_P(MotorEffort, OfAMotorThatPushesAgainstStiction) {
  Simulator simulator(stickyBar(std::get<0>(GetParam()), std::get<1>(GetParam())), model::UriResolver());
  simulator.commandJoints(0, {{"hinge"}, {1.0}, {}, {}});
  stepFor(&simulator, 0.1);
  EXPECT_LT(std::abs(simulator.report().joints[0].position), 1e-6);
  EXPECT_NEAR(simulator.report().joints[0].effort, 20, 1e-4);
  const MotorCurrentReading value = reading<MotorCurrentReading>(simulator.report(), 0);
  EXPECT_NEAR(value.efforts[0], 20, 1e-4);
  EXPECT_NEAR(value.currents[0], 40, 2e-4);
}

// Friction holds what is applied from outside; the motor, on its target, does nothing.
TEST_P(MotorEffort, IsNotTheEffortFromOutside) {
  Simulator simulator(stickyBar(std::get<0>(GetParam()), std::get<1>(GetParam())), model::UriResolver());
  simulator.applyEffort(0, 15, {0, -1});
  stepFor(&simulator, 0.1);
  EXPECT_NEAR(simulator.report().joints[0].effort, 0, 1e-4);
  EXPECT_NEAR(reading<MotorCurrentReading>(simulator.report(), 0).currents[0], 0, 2e-4);
  simulator.applyEffort(0, 15, {0, -1});  // 30 N m: more than friction holds
  stepFor(&simulator, 0.1);
  EXPECT_GT(simulator.report().joints[0].position, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Laws, MotorEffort,
                         ::testing::Combine(::testing::Values("articulated", "world_step", "quick_step"),
                                            ::testing::Values(MotorLaw::PID, MotorLaw::IMPLICIT_PD)));

// Two fingers, the second a mimic of the first, are pressed against their stops: the motor's effort is its law's, and the mimic has none.
TEST(MotorEffortOfMimics, IsTheMastersWhole) {
  SimulationConfig config;
  config.gravity.setZero();
  config.robots = {robot("gripper", R"(<robot name="gripper"><link name="palm"/>
    <link name="left"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <link name="right"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="left" type="prismatic"><parent link="palm"/><child link="left"/><axis xyz="1 0 0"/>
      <limit lower="0" upper="0.04" effort="100" velocity="1"/></joint>
    <joint name="right" type="prismatic"><parent link="palm"/><child link="right"/><axis xyz="-1 0 0"/>
      <limit lower="0" upper="0.04" effort="100" velocity="1"/><mimic joint="left"/></joint></robot>)",
                         true)};
  config.robots[0].gains["default"] = {1000, 0, 50};
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"left"}, {0.05}, {}, {}});
  stepFor(&simulator, 1);
  EXPECT_NEAR(simulator.report().joints[0].position, 0.04, 1e-4);
  EXPECT_NEAR(simulator.report().joints[0].effort, 1000 * (0.05 - simulator.report().joints[0].position), 1e-3);
  EXPECT_EQ(simulator.report().joints[1].effort, 0);
}

}  // namespace
}  // namespace blem_sim::sim
