// Once warm, a step of the simulator asks the heap for nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/simulation_scene.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

#include "support/counted_allocations.h"
#include "support/moving_shapes.h"

namespace blem_sim::sim {
namespace {

constexpr int WARM_UP = 300, WATCHED = 500;  // [steps]

SensorConfig sensorOfType(SensorType type) {
  SensorConfig sensor;
  sensor.name = "sensor" + std::to_string(static_cast<int>(type));
  sensor.type = type;
  sensor.link = "arm";
  sensor.joint = "hinge";
  return sensor;
}

/** A motor driven arm with every kind of sensor, and a ball beside it that falls past. */
SimulationConfig allocatingScene() {
  SimulationConfig config;
  RobotConfig arm = robot("arm_with_a_name_too_long_for_a_short_string", pendulumUrdf(), true);
  arm.gains["default"] = {300, 10, 20, 100};
  for (const SensorType type :
       {SensorType::FORCE_TORQUE, SensorType::IMU, SensorType::CONTACT, SensorType::TILT, SensorType::MOTOR_CURRENT})
    arm.sensors.push_back(sensorOfType(type));
  config.robots = {arm};
  config.objects = {box("falling", Vector3::Constant(0.1), 1, Vector3(3, 0, 100))};
  return config;
}

long allocationsOf(Simulator* simulator) {
  const long before = allocations;
  simulator->step();
  return allocations - before;
}

long allocationsOfWarmSteps(Simulator* simulator, int warm_up = WARM_UP, int watched = WATCHED) {
  for (int i = 0; i < warm_up; ++i) simulator->step();
  long allocated = 0;
  for (int i = 0; i < watched; ++i) allocated += allocationsOf(simulator);
  return allocated;
}

TEST(StepAllocation, NoneInAWarmStepWithoutContacts) {
  Simulator simulator(allocatingScene(), model::UriResolver());
  EXPECT_EQ(allocationsOfWarmSteps(&simulator), 0);
  EXPECT_EQ(simulator.report().samples.size(), 5u);
}

TEST(StepAllocation, NoneInAWarmStepOfAStack) {
  SimulationConfig config = allocatingScene();
  config.environments = {ground()};
  config.objects = {box("lower", Vector3::Constant(0.1), 1, Vector3(3, 0, 0.053)),
                    box("upper", Vector3::Constant(0.1), 1, Vector3(3, 0, 0.158))};
  config.environments[0].uri = meshFile("fine_ground", geometry::gridMesh(8, 1, 800, 100));
  Simulator simulator(config, model::UriResolver());
  EXPECT_EQ(allocationsOfWarmSteps(&simulator), 0);
  EXPECT_EQ(simulator.report().reduced_contacts, 8);
}

TEST(StepAllocation, NoneInAWarmStepOnUsedUpLayers) {
  SimulationConfig config = allocatingScene();
  config.environments = {ground()};
  config.objects = {box("heavy", Vector3::Constant(0.1), 100, Vector3(0.5, 0, 0.0525))};
  config.objects[0].contact.stiffness = 1e4;
  config.objects[0].contact.damping = 200;
  Simulator simulator(config, model::UriResolver());
  EXPECT_EQ(allocationsOfWarmSteps(&simulator), 0);
  EXPECT_EQ(simulator.report().contacts.size(), 8u);
}

TEST(StepAllocation, NoneInAWarmStepMadeInParts) {
  SimulationConfig config = allocatingScene();
  config.environments = {ground(20)};
  config.environments[0].contact.friction = 0;
  config.objects = {box("gliding", Vector3::Constant(0.1), 1, Vector3(-5, 3, 0.0525))};
  config.objects[0].linear_velocity = {6, 0, 0};
  Simulator simulator(config, model::UriResolver());
  EXPECT_EQ(allocationsOfWarmSteps(&simulator), 0);
  EXPECT_GT(simulator.report().substeps, 1);
  EXPECT_EQ(simulator.report().contacts.size(), 4u);
}

ObjectConfig bodyOfMesh(const std::string& name, const geometry::TriangleMesh& mesh, double mass, const Pose& pose) {
  ObjectConfig object;
  object.name = name;
  object.uri = meshFile(name, mesh);
  object.mass = mass;
  object.X_WO = pose;
  object.contact.boundary_width = 0.001;
  return object;
}

std::string wheelUrdf(const std::string& mesh) {
  return R"(<robot name="wheel"><link name="base"/>
    <link name="gear"><inertial><mass value="1"/><inertia ixx="1e-3" iyy="1e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><geometry><mesh filename=")" +
         mesh + R"("/></geometry></collision></link>
    <joint name="axle" type="continuous"><parent link="base"/><child link="gear"/><axis xyz="0 0 1"/></joint></robot>)";
}

// Two gears, one driven: other teeth touch all the time. They are warm after one turn.
TEST(StepAllocation, NoneInAWarmStepOfGears) {
  constexpr int TEETH = 20;
  constexpr double ROOT = 0.09, TIP = 0.11, LAYER = 0.0005;
  const std::string mesh = meshFile("gear", gearMesh(TEETH, ROOT, TIP, 0.02));
  SimulationConfig config;
  for (const int i : {0, 1}) {
    RobotConfig wheel = robot("wheel" + std::to_string(i), wheelUrdf(mesh), true);
    wheel.X_WR = makePose({0.202 * i, 0, 0}, {0, 0, i * M_PI / TEETH});
    wheel.contact.boundary_width = LAYER;
    wheel.joint_friction["default"] = {0.01, 0.01};
    config.robots.push_back(wheel);
  }
  config.robots[0].gains["default"] = {0, 0, 10, 0};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"axle"}, {}, {3.0}, {}});
  EXPECT_EQ(allocationsOfWarmSteps(&simulator, 4000), 0);
  EXPECT_NEAR(simulator.report().joints[1].velocity, -3, 1.5);
}

// Rings that hang in each other and swing. Until each pair of them has been as near as it gets, its lists still grow.
TEST(StepAllocation, NoneInWarmStepsOfAHangingChain) {
  constexpr int RINGS = 5;
  constexpr double RADIUS = 0.03, THICKNESS = 0.004;
  const geometry::TriangleMesh ring = ringMesh(RADIUS, THICKNESS, 40, 12);
  SimulationConfig config;
  EnvironmentConfig hook;
  hook.name = "hook";
  hook.uri = meshFile("hook", ring);
  hook.X_WE = makePose({0, 0, 1}, {M_PI / 2, 0, 0});
  config.environments = {hook};
  for (int i = 1; i <= RINGS; ++i) {
    const Pose pose = makePose({0, 0, 1 - 2 * i * (RADIUS - THICKNESS - 0.001)}, {M_PI / 2, 0, i % 2 ? M_PI / 2 : 0});
    config.objects.push_back(bodyOfMesh("ring" + std::to_string(i), ring, 0.05, pose));
  }
  config.objects.back().linear_velocity = {0.3, 0.2, 0};
  Simulator simulator(config, model::UriResolver());
  EXPECT_EQ(allocationsOfWarmSteps(&simulator, 16000, 2000), 0);
  EXPECT_GT(bodyOf(simulator, "ring5").v_WCom.norm(), 1e-3);
  EXPECT_GT(bodyOf(simulator, "ring5").X_WB.translation().z(), 0.6);
  EXPECT_GE(simulator.report().reduced_contacts, RINGS);
}

}  // namespace
}  // namespace blem_sim::sim

#endif
