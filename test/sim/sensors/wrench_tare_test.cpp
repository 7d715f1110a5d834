// Force-torque sensors that take what they measure for zero.
#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double WEIGHT = 2 * G;  // [N] of the pendulum's arm

SimulationConfig heldArm() {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  config.robots[0].gains["default"] = {1e6, 0, 1e4};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  SensorConfig wrench, tilt;
  wrench.name = "wrench";
  wrench.type = SensorType::FORCE_TORQUE;
  wrench.joint = "hinge";
  tilt.name = "tilt";
  tilt.type = SensorType::TILT;
  tilt.link = "arm";
  config.robots[0].sensors = {wrench, tilt};
  return config;
}

ForceTorqueReading wrenchOf(Simulator* simulator) { return reading<ForceTorqueReading>(simulator->step(), 0); }

TEST(WrenchTare, MakesWhatIsMeasuredNextTheZero) {
  Simulator simulator(heldArm(), model::UriResolver());
  stepFor(&simulator, 0.2);
  const ForceTorqueReading before = wrenchOf(&simulator);
  EXPECT_NEAR(before.force.z(), WEIGHT, 1e-5);
  simulator.tareSensor(0);
  const ForceTorqueReading zero = wrenchOf(&simulator);
  EXPECT_EQ(zero.force, Vector3(0, 0, 0));
  EXPECT_EQ(zero.torque, Vector3(0, 0, 0));
  simulator.applyLoad({simulator.robots()[0].bodies[1], {{0, 0, -5}, Vector3::Zero()}, {0.5, 0, 0}}, {0, -1});
  stepFor(&simulator, 0.2);
  EXPECT_NEAR(wrenchOf(&simulator).force.z(), 5, 1e-4);
  EXPECT_NEAR(wrenchOf(&simulator).torque.y(), -2.5, 1e-4);
}

TEST(WrenchTare, IsBeforeNoiseAndLimits) {
  SimulationConfig config = heldArm();
  config.robots[0].sensors[0].noise[0].bias = 3;
  config.robots[0].sensors[0].limits[0].saturation = 10;
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.2);
  EXPECT_EQ(wrenchOf(&simulator).force.z(), 10);
  simulator.tareSensor(0);
  EXPECT_EQ(wrenchOf(&simulator).force, Vector3(3, 3, 3));
  EXPECT_EQ(std::get<ForceTorqueReading>(simulator.report().samples.at(0).truth.value()).force, Vector3(0, 0, 0));
}

TEST(WrenchTare, IsPartOfTheStateAndEndsWithAReset) {
  const SimulationConfig config = heldArm();
  Simulator straight(config, model::UriResolver()), restored(config, model::UriResolver());
  stepFor(&straight, 0.2);
  const std::uint64_t before = straight.stateHash();
  straight.tareSensor(0);
  EXPECT_NE(straight.stateHash(), before) << "a tare that is asked for";
  restored.restore(straight.save());
  EXPECT_EQ(wrenchOf(&restored).force, Vector3(0, 0, 0));
  straight.step();
  EXPECT_EQ(restored.stateHash(), straight.stateHash());
  Simulator later(config, model::UriResolver());
  later.restore(straight.save());
  EXPECT_EQ(wrenchOf(&later).force, wrenchOf(&straight).force);
  EXPECT_LT(wrenchOf(&later).force.norm(), 1e-6);
  straight.setPhysics({0, 0, -G}, 0.0005, 1);
  EXPECT_LT(wrenchOf(&straight).force.norm(), 1e-3) << "sensors are made again";
  straight.resetWorld();
  stepFor(&straight, 0.2);
  EXPECT_NEAR(wrenchOf(&straight).force.z(), WEIGHT, 1e-4);
}

TEST(WrenchTare, OfAnotherSensorIsRefused) {
  Simulator simulator(heldArm(), model::UriResolver());
  EXPECT_THROW(simulator.tareSensor(1), InputError);
}

}  // namespace
}  // namespace blem_sim::sim
