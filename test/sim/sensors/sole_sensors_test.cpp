// Contact switches and centres of pressure, against contacts and statics.
#include <cmath>

#include "blem_sim/sim/sensor_values.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

/** A foot of 10 kg, 0.2 x 0.1 x 0.05 m, its centre of mass off the middle. */
const char* const TEN_KILO_FOOT = R"(<robot name="foot"><link name="sole"><inertial><origin xyz="0.03 -0.02 0.01"/><mass value="10"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="0.2 0.1 0.05"/></geometry></collision></link></robot>)";
constexpr double STANDING = 0.0275;  // [m] of the foot's middle, layer included

SensorConfig onSole(const std::string& name, SensorType type, double threshold) {
  SensorConfig config;
  config.name = name;
  config.type = type;
  config.link = "sole";
  config.threshold = threshold;
  return config;
}

SimulationConfig footAt(double height, const std::vector<SensorConfig>& sensors) {
  SimulationConfig config;
  EnvironmentConfig ground;
  ground.name = "ground";
  ground.plane = Eigen::Vector4d(0, 0, 1, 0);
  config.environments = {ground};
  config.robots = {robot("foot", TEN_KILO_FOOT, false)};
  config.robots[0].X_WR = makePose({0.5, 0.2, height}, {0, 0, 0.4});
  config.robots[0].sensors = sensors;
  return config;
}

std::vector<SensorSample> samplesOf(const StepReport& report, int sensor) {
  std::vector<SensorSample> samples;
  for (const SensorSample& sample : report.samples)
    if (sample.sensor == sensor) samples.push_back(sample);
  return samples;
}

TEST(ContactSwitch, ClosesWhereTheForceIsBeyondItsThreshold) {
  Simulator simulator(footAt(STANDING, {onSole("light", SensorType::CONTACT_SWITCH, 0), onSole("below", SensorType::CONTACT_SWITCH, 98),
                                        onSole("above", SensorType::CONTACT_SWITCH, 98.2)}),
                      model::UriResolver());
  stepFor(&simulator, 1);
  EXPECT_NEAR(reading<ContactSwitchReading>(simulator.report(), 0).force, 10 * G, 1e-6 * 10 * G);
  EXPECT_TRUE(reading<ContactSwitchReading>(simulator.report(), 0).closed);
  EXPECT_TRUE(reading<ContactSwitchReading>(simulator.report(), 1).closed);
  EXPECT_FALSE(reading<ContactSwitchReading>(simulator.report(), 2).closed);
}

TEST(ContactSwitch, IsOpenInFlight) {
  Simulator simulator(footAt(0.5, {onSole("light", SensorType::CONTACT_SWITCH, 0)}), model::UriResolver());
  simulator.step();
  EXPECT_FALSE(reading<ContactSwitchReading>(simulator.report(), 0).closed);
  EXPECT_EQ(reading<ContactSwitchReading>(simulator.report(), 0).force, 0);
}

TEST(ContactSwitch, FeelsBothSidesOfASqueeze) {
  SimulationConfig config = footAt(STANDING, {onSole("light", SensorType::CONTACT_SWITCH, 0)});
  config.objects = {box("load", {0.1, 0.05, 0.1}, 5, {0.5, 0.2, 2 * STANDING + 0.0525})};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 1);
  EXPECT_NEAR(reading<ContactSwitchReading>(simulator.report(), 0).force, (15 + 5) * G, 0.1);
}

TEST(ContactSwitch, GoesByWhatItReads) {
  SensorConfig late = onSole("late", SensorType::CONTACT_SWITCH, 150), biased = onSole("biased", SensorType::CONTACT_SWITCH, 150);
  late.delay = 0.05;
  biased.noise[0].bias = 100;
  Simulator simulator(footAt(STANDING, {late, biased, onSole("exact", SensorType::CONTACT_SWITCH, 150)}), model::UriResolver());
  stepFor(&simulator, 0.5);
  const SensorSample now = samplesOf(simulator.report(), 1).at(0);
  EXPECT_TRUE(std::get<ContactSwitchReading>(now.reading).closed);
  EXPECT_FALSE(std::get<ContactSwitchReading>(now.truth.value()).closed);
  // Thrown up, it is pressed in the reading for as long as the delay.
  dynamics::BodyState state = bodyOf(simulator, "foot");
  state.X_WB.translation().z() += 1;
  simulator.moveModel(simulator.models()[simulator.modelIndex("foot")].bodies[0], state);
  int steps = 0;
  while (reading<ContactSwitchReading>(simulator.step(), 0).force > 0) ++steps;
  EXPECT_EQ(steps, 50);
}

TEST(CentreOfPressure, IsBelowTheCentreOfMassOfAStandingFoot) {
  SensorConfig plain = onSole("plain", SensorType::CENTRE_OF_PRESSURE, 0), turned = plain;
  turned.name = "turned";
  turned.X_LS = makePose({0.01, 0.02, -0.025}, {0, 0, M_PI / 2});
  Simulator simulator(footAt(STANDING, {plain, turned}), model::UriResolver());
  stepFor(&simulator, 1);
  const auto at = reading<CentreOfPressureReading>(simulator.report(), 0);
  EXPECT_NEAR(at.force, 10 * G, 1e-6 * 10 * G);
  EXPECT_NEAR(at.x, 0.03, 1e-5);
  EXPECT_NEAR(at.y, -0.02, 1e-5);
  const auto seen = reading<CentreOfPressureReading>(simulator.report(), 1);
  EXPECT_NEAR(seen.x, -0.04, 1e-5);
  EXPECT_NEAR(seen.y, -0.02, 1e-5);
}

TEST(CentreOfPressure, IsThatOfTheContacts) {
  SensorConfig sole = onSole("sole", SensorType::CENTRE_OF_PRESSURE, 0);
  sole.X_LS = makePose({0, 0, -0.0275});
  Simulator simulator(footAt(STANDING, {sole}), model::UriResolver());
  stepFor(&simulator, 0.5);
  const Pose X_WL = bodyOf(simulator, "foot").X_WB;
  const StepReport& report = simulator.step();
  Vector3 sum = Vector3::Zero();
  double force = 0;
  for (const ContactReport& contact : report.contacts) {
    const double up = std::abs(contact.force.z());
    sum += up * (X_WL.inverse() * contact.point);
    force += up;
  }
  const auto at = reading<CentreOfPressureReading>(report, 0);
  EXPECT_NEAR(at.x, sum.x() / force, 1e-5);
  EXPECT_NEAR(at.y, sum.y() / force, 1e-5);
}

TEST(CentreOfPressure, IsThatOfTheAnklesWrench) {
  const char* const LEG = R"(<robot name="leg"><link name="shank"><inertial><origin xyz="0.03 -0.02 0.1"/><mass value="9"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <link name="sole"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.2 0.1 0.05"/></geometry></collision></link>
    <joint name="ankle" type="fixed"><parent link="shank"/><child link="sole"/></joint></robot>)";
  SensorConfig ankle = onSole("ankle", SensorType::FORCE_TORQUE, 0);
  ankle.joint = "ankle";
  SimulationConfig config = footAt(STANDING, {onSole("sole", SensorType::CENTRE_OF_PRESSURE, 0), ankle});
  config.robots[0].urdf_xml = LEG;
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 1);
  const auto centre = reading<CentreOfPressureReading>(simulator.report(), 0);
  const auto wrench = reading<ForceTorqueReading>(simulator.report(), 1);
  // The ground bears the sole's own weight, too, which acts at its origin.
  const double ground = -wrench.force.z() + 1 * G;
  EXPECT_NEAR(ground / (10 * G), 1, 1e-6);
  EXPECT_NEAR(centre.force / ground, 1, 1e-6);
  EXPECT_NEAR(centre.x, wrench.torque.y() / ground, 1e-5);
  EXPECT_NEAR(centre.y, -wrench.torque.x() / ground, 1e-5);
  EXPECT_NEAR(centre.x, 0.027, 1e-5);
}

TEST(CentreOfPressure, IsNotReadWhileNothingPresses) {
  SensorConfig late = onSole("late", SensorType::CENTRE_OF_PRESSURE, 0);
  late.delay = 0.02;
  SensorConfig noisy = onSole("noisy", SensorType::CENTRE_OF_PRESSURE, 0);
  noisy.noise[0].stddev = 0.01;
  Simulator simulator(footAt(STANDING + 0.02, {onSole("plain", SensorType::CENTRE_OF_PRESSURE, 0), late, noisy,
                                               onSole("heavy", SensorType::CENTRE_OF_PRESSURE, 1e6)}),
                      model::UriResolver());
  int first = 0, first_late = 0, step = 0;
  while (step < 300) {
    const StepReport& report = simulator.step();
    ++step;
    if (first == 0 && !samplesOf(report, 0).empty()) first = step;
    if (first_late == 0 && !samplesOf(report, 1).empty()) first_late = step;
    EXPECT_EQ(samplesOf(report, 0).empty(), samplesOf(report, 2).empty()) << step;
    EXPECT_TRUE(samplesOf(report, 3).empty());
  }
  EXPECT_NEAR(first, std::sqrt(2 * 0.02 / G) / 0.001, 3);
  EXPECT_EQ(first_late, first + 20);
  EXPECT_TRUE(samplesOf(simulator.report(), 2).at(0).truth.has_value());
}

TEST(SoleSensors, GoOnFromASavedState) {
  SensorConfig push = onSole("push", SensorType::CONTACT_SWITCH, 1), centre = onSole("centre", SensorType::CENTRE_OF_PRESSURE, 1);
  for (SensorConfig* sensor : {&push, &centre}) {
    sensor->delay = 0.01;
    sensor->noise[0] = {0.1, 0.1, 0.1, 0.1};
  }
  const SimulationConfig config = footAt(STANDING, {push, centre});
  Simulator straight(config, model::UriResolver()), restored(config, model::UriResolver());
  stepFor(&straight, 0.1);
  restored.restore(straight.save());
  for (int i = 0; i < 30; ++i) {
    straight.step();
    restored.step();
    for (const int sensor : {0, 1})
      ASSERT_EQ(sensorValues(samplesOf(straight.report(), sensor).at(0).reading).values,
                sensorValues(samplesOf(restored.report(), sensor).at(0).reading).values);
  }
  EXPECT_EQ(straight.stateHash(), restored.stateHash());
}

}  // namespace
}  // namespace blem_sim::sim
