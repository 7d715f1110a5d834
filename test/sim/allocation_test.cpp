// Once warm, a step of the simulator asks the heap for nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "simulation_scene.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

#include "support/counted_allocations.h"

namespace blem_sim {
namespace {

constexpr int WARM_UP = 300, WATCHED = 500;  // [steps]

SensorConfig sensorOf(SensorType type) {
  SensorConfig sensor;
  sensor.name = "sensor" + std::to_string(static_cast<int>(type));
  sensor.type = type;
  sensor.link = "arm";
  sensor.joint = "hinge";
  return sensor;
}

/** A motor driven arm with every kind of sensor, and a ball beside it that falls past. */
SimulationConfig busyScene() {
  SimulationConfig config;
  RobotConfig arm = robot("arm_with_a_name_too_long_for_a_short_string", pendulumUrdf(), true);
  arm.gains["default"] = {300, 10, 20, 100};
  for (const SensorType type :
       {SensorType::FORCE_TORQUE, SensorType::IMU, SensorType::CONTACT, SensorType::TILT, SensorType::MOTOR_CURRENT})
    arm.sensors.push_back(sensorOf(type));
  config.robots = {arm};
  config.objects = {box("falling", Vector3::Constant(0.1), 1, Vector3(3, 0, 100))};
  return config;
}

long allocationsOf(Simulator* simulator) {
  const long before = allocations;
  simulator->step();
  return allocations - before;
}

long allocationsOfWarmSteps(Simulator* simulator) {
  for (int i = 0; i < WARM_UP; ++i) simulator->step();
  long allocated = 0;
  for (int i = 0; i < WATCHED; ++i) allocated += allocationsOf(simulator);
  return allocated;
}

TEST(StepAllocation, NoneInAWarmStepWithoutContacts) {
  Simulator simulator(busyScene(), UriResolver());
  EXPECT_EQ(allocationsOfWarmSteps(&simulator), 0);
  EXPECT_EQ(simulator.report().samples.size(), 5u);
}

TEST(StepAllocation, NoneInAWarmStepOfAStack) {
  SimulationConfig config = busyScene();
  config.environments = {ground()};
  config.objects = {box("lower", Vector3::Constant(0.1), 1, Vector3(3, 0, 0.053)),
                    box("upper", Vector3::Constant(0.1), 1, Vector3(3, 0, 0.158))};
  config.environments[0].uri = meshFile("fine_ground", gridMesh(8, 1, 800, 100));
  Simulator simulator(config, UriResolver());
  EXPECT_EQ(allocationsOfWarmSteps(&simulator), 0);
  EXPECT_EQ(simulator.report().reduced_contacts, 8);
}

TEST(StepAllocation, NoneInAWarmStepOnUsedUpLayers) {
  SimulationConfig config = busyScene();
  config.environments = {ground()};
  config.objects = {box("heavy", Vector3::Constant(0.1), 100, Vector3(0.5, 0, 0.0525))};
  config.objects[0].contact.stiffness = 1e4;
  config.objects[0].contact.damping = 200;
  Simulator simulator(config, UriResolver());
  EXPECT_EQ(allocationsOfWarmSteps(&simulator), 0);
  EXPECT_EQ(simulator.report().contacts.size(), 8u);
}

TEST(StepAllocation, NoneInAWarmStepMadeInParts) {
  SimulationConfig config = busyScene();
  config.environments = {ground(20)};
  config.environments[0].contact.friction = 0;
  config.objects = {box("gliding", Vector3::Constant(0.1), 1, Vector3(-5, 3, 0.0525))};
  config.objects[0].linear_velocity = {6, 0, 0};
  Simulator simulator(config, UriResolver());
  EXPECT_EQ(allocationsOfWarmSteps(&simulator), 0);
  EXPECT_GT(simulator.report().substeps, 1);
  EXPECT_EQ(simulator.report().contacts.size(), 4u);
}

}  // namespace
}  // namespace blem_sim

#endif
