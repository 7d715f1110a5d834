// Sensors against hand calculation: frames, origins and signs.
#include <cmath>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

SensorConfig sensor(const std::string& name, SensorType type, const std::string& link = "") {
  SensorConfig config;
  config.name = name;
  config.type = type;
  config.link = link;
  return config;
}

SensorConfig forceTorque(const std::string& name, const std::string& joint, const std::string& frame, const std::string& measure) {
  SensorConfig config = sensor(name, SensorType::FORCE_TORQUE);
  config.joint = joint;
  config.frame = frame;
  config.measure = measure;
  return config;
}

void expectNear(const Vector3& value, const Vector3& expected, double tolerance) {
  EXPECT_LT((value - expected).norm(), tolerance) << value.transpose() << " against " << expected.transpose();
}

/** A wrist of 2 kg, its centre of mass at (0.1, 0, 0) from a fixed joint turned by -90 degrees about y against the mast. */
const char* const MAST = R"(<robot name="mast">
  <link name="mast"><inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="wrist"><inertial><origin xyz="0.1 0 0"/><mass value="2"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="flange" type="fixed"><parent link="mast"/><child link="wrist"/>
    <origin xyz="0.3 0 0.5" rpy="0 -1.5707963267948966 0"/></joint>
</robot>)";

TEST(ForceTorqueSensor, WeightAndMomentInEveryFrameAndSign) {
  SimulationConfig config;
  config.robots = {robot("mast", MAST, true)};
  // The base is turned by 90 degrees about x: gravity is along -y of the mast.
  config.robots[0].X_WR = makePose({0, 0, 1}, {M_PI / 2, 0, 0});
  for (const char* frame : {"child", "parent", "sensor", "mast"})
    for (const char* measure : {"parent_to_child", "child_to_parent"})
      config.robots[0].sensors.push_back(forceTorque(std::string(frame) + measure, "flange", frame, measure));
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.2);

  // Wrench in the mast's axes: com at R_y(-90) (0.1, 0, 0) = (0, 0, 0.1) from the flange; gravity -y; the wrist is held up by +y.
  const Vector3 force_P(0, 2 * G, 0), p_PF(0.3, 0, 0.5), arm(0, 0, 0.1);
  const Matrix3 R_CP = makePose(Vector3::Zero(), {0, -M_PI / 2, 0}).linear().transpose();
  for (int i = 0; i < 8; ++i) {
    const ForceTorqueReading value = reading<ForceTorqueReading>(simulator.report(), i);
    const double sign = i % 2 == 0 ? 1 : -1;
    const bool of_mast = i / 2 == 1 || i / 2 == 3;
    const Matrix3 R_AP = of_mast ? Matrix3(Matrix3::Identity()) : R_CP;
    const Vector3 torque_P = (of_mast ? Vector3(p_PF + arm) : arm).cross(force_P);
    expectNear(value.force, sign * (R_AP * force_P), 1e-6);
    expectNear(value.torque, sign * (R_AP * torque_P), 1e-6);
    EXPECT_EQ(value.frame_id, i / 2 == 0 ? "wrist" : "mast") << "the joint's frame is fixed in the parent";
  }
}

TEST(ForceTorqueSensor, AxesOfAMovedHinge) {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  config.robots[0].initial_positions["hinge"] = 0.6;
  config.robots[0].gains["default"] = {1e6, 0, 1e4};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  config.robots[0].sensors = {forceTorque("child", "hinge", "child", "parent_to_child"),
                              forceTorque("sensor", "hinge", "sensor", "parent_to_child")};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.5);
  const double q = simulator.report().joints[0].position;
  const ForceTorqueReading child = reading<ForceTorqueReading>(simulator.report(), 0);
  // Child's axes are turned by q about y against the world's.
  expectNear(child.force, 2 * G * Vector3(-std::sin(q), 0, std::cos(q)), 1e-5);
  expectNear(child.torque, {0, -0.5 * 2 * G * std::cos(q), 0}, 1e-5);
  const ForceTorqueReading joint = reading<ForceTorqueReading>(simulator.report(), 1);
  expectNear(joint.force, {0, 0, 2 * G}, 1e-5);
}

TEST(ForceTorqueSensor, NoiseHasItsDeviation) {
  SimulationConfig config;
  config.robots = {robot("mast", MAST, true)};
  config.robots[0].sensors = {forceTorque("wrist", "flange", "parent", "parent_to_child")};
  config.robots[0].sensors[0].noise[0].stddev = 0.5;
  Simulator simulator(config, model::UriResolver());
  double sum = 0, sum_of_squares = 0;
  constexpr int COUNT = 4000;
  for (int i = 0; i < COUNT; ++i) {
    const double error = reading<ForceTorqueReading>(simulator.step(), 0).force.z() - 2 * G;
    sum += error;
    sum_of_squares += error * error;
  }
  EXPECT_NEAR(sum / COUNT, 0, 0.03);
  EXPECT_NEAR(std::sqrt(sum_of_squares / COUNT), 0.5, 0.02);
}

TEST(ImuSensor, AtRestItFeelsTheGround) {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  SensorConfig on_base = sensor("imu", SensorType::IMU, "base");
  on_base.X_LS = makePose({0.1, 0.2, 0.3}, {M_PI / 2, 0, 0});
  config.robots[0].sensors = {on_base};
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  const ImuReading value = reading<ImuReading>(simulator.report(), 0);
  expectNear(value.linear_acceleration, {0, G, 0}, 1e-12);
  expectNear(value.angular_velocity, Vector3::Zero(), 1e-12);
  EXPECT_NEAR(value.orientation.angularDistance(Quaternion(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitX()))), 0, 1e-7);
}

TEST(ImuSensor, InFreeFallItFeelsNothing) {
  SimulationConfig config;
  config.robots = {robot("mast", MAST, false)};
  config.robots[0].X_WR = makePose({0, 0, 10}, {0.3, 0.2, 0.1});
  SensorConfig imu = sensor("imu", SensorType::IMU, "wrist");
  imu.X_LS = makePose({0.3, 0, 0});
  config.robots[0].sensors = {imu, sensor("tilt", SensorType::TILT, "mast")};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.1);
  expectNear(reading<ImuReading>(simulator.report(), 0).linear_acceleration, Vector3::Zero(), 1e-9);
  const TiltReading tilt = reading<TiltReading>(simulator.report(), 1);
  EXPECT_NEAR(tilt.roll, 0.3, 1e-9);
  EXPECT_NEAR(tilt.pitch, 0.2, 1e-9);
}

/** A balanced disc about z on a post: its motor alone turns it. */
const char* const SENSOR_TABLE = R"(<robot name="turntable">
  <link name="post"/>
  <link name="disc"><inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.2" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="spin" type="continuous"><parent link="post"/><child link="disc"/><axis xyz="0 0 1"/></joint>
</robot>)";

TEST(ImuSensor, OnATurntableItFeelsTheCentre) {
  SimulationConfig config;
  config.robots = {robot("turntable", SENSOR_TABLE, true)};
  config.robots[0].gains["default"] = {0, 0, 50};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  SensorConfig imu = sensor("imu", SensorType::IMU, "disc");
  imu.X_LS = makePose({0.2, 0, 0});
  imu.rate = 200;
  config.robots[0].sensors = {imu};
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"spin"}, {}, {3.0}, {}});
  stepFor(&simulator, 1);
  EXPECT_NEAR(simulator.report().joints[0].velocity, 3, 1e-6);
  const ImuReading value = reading<ImuReading>(simulator.report(), 0);
  // omega^2 r inwards; the speed is a difference over a chord, shorter by (omega dt)^2 / 24.
  expectNear(value.linear_acceleration, {-9 * 0.2, 0, G}, 1e-5);
  expectNear(value.angular_velocity, {0, 0, 3}, 1e-6);
}

TEST(ImuSensor, FeelsTangentialAccelerationAtItsLeverArm) {
  SimulationConfig config;
  config.robots = {robot("turntable", SENSOR_TABLE, true)};
  SensorConfig imu = sensor("imu", SensorType::IMU, "disc");
  imu.X_LS = makePose({0.2, 0, 0});
  config.robots[0].sensors = {imu};
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"spin"}, {}, {}, {0.4}});
  simulator.step();
  simulator.step();
  // 0.4 N m on 0.2 kg m^2.
  EXPECT_NEAR(reading<ImuReading>(simulator.report(), 0).linear_acceleration.y(), 2 * 0.2, 1e-5);
}

TEST(ImuSensor, BiasWalksAndResets) {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  SensorConfig imu = sensor("imu", SensorType::IMU, "base");
  imu.noise[1].bias_stddev = 1;
  config.robots[0].sensors = {imu};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 1);
  const double strayed = reading<ImuReading>(simulator.report(), 0).angular_velocity.norm();
  EXPECT_GT(strayed, 0.1);
  EXPECT_LT(strayed, 6);
  simulator.resetWorld();
  simulator.step();
  EXPECT_LT(reading<ImuReading>(simulator.report(), 0).angular_velocity.norm(), 0.3);
}

/** Readings of a noisy IMU of the first robot in 100 steps. */
std::vector<Vector3> imuNoise(const SimulationConfig& config) {
  Simulator simulator(config, model::UriResolver());
  std::vector<Vector3> noise;
  for (int i = 0; i < 100; ++i) {
    simulator.step();
    for (std::size_t s = 0; s < simulator.sensors().size(); ++s)
      if (simulator.sensors()[s].robot == 0 && simulator.sensors()[s].config.name == "imu")
        noise.push_back(reading<ImuReading>(simulator.report(), static_cast<int>(s)).angular_velocity);
  }
  return noise;
}

TEST(Sensors, NoiseIsAStreamOfEachSensorsOwn) {
  SensorConfig imu = sensor("imu", SensorType::IMU, "base");
  imu.noise[1].stddev = 0.1;
  SimulationConfig alone;
  alone.robots = {robot("pendulum", pendulumUrdf(), true)};
  alone.robots[0].sensors = {imu};
  SimulationConfig beside = alone;
  imu.name = "another";
  beside.robots[0].sensors.insert(beside.robots[0].sensors.begin(), imu);
  imu.name = "imu";
  beside.robots.push_back(robot("second", pendulumUrdf(), true));
  beside.robots[1].sensors = {imu};
  const std::vector<Vector3> noise = imuNoise(alone);
  ASSERT_EQ(noise.size(), 100u);
  EXPECT_EQ(imuNoise(beside), noise);
  Simulator two(beside, model::UriResolver());
  two.step();
  EXPECT_NE(reading<ImuReading>(two.report(), 0).angular_velocity, reading<ImuReading>(two.report(), 1).angular_velocity);
  SimulationConfig other_seed = alone;
  other_seed.random_seed = 2;
  EXPECT_NE(imuNoise(other_seed), noise);
  SimulationConfig other_name = alone;
  other_name.robots[0].name = "other";
  EXPECT_NE(imuNoise(other_name), noise);
}

TEST(Sensors, RateIsAWholeNumberOfStepsFromStepZero) {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  SensorConfig imu = sensor("imu", SensorType::IMU, "arm");
  imu.rate = 250;
  config.robots[0].sensors = {imu, sensor("tilt", SensorType::TILT, "arm")};
  Simulator simulator(config, model::UriResolver());
  for (int i = 1; i <= 12; ++i) EXPECT_EQ(simulator.step().samples.size(), i % 4 == 0 ? 2u : 1u) << i;
}

const char* const FOOT = R"(<robot name="foot">
  <link name="body"><inertial><origin xyz="0.02 0 0"/><mass value="3"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.2 0.1 0.1"/></geometry></collision></link>
  <link name="hat"><collision><origin xyz="0 0 0.2"/><geometry><sphere radius="0.02"/></geometry></collision></link>
  <joint name="neck" type="fixed"><parent link="body"/><child link="hat"/></joint>
</robot>)";

TEST(ContactSensor, TotalIsTheWeight) {
  SimulationConfig config;
  config.environments = {ground()};
  config.robots = {robot("foot", FOOT, false)};
  config.robots[0].X_WR = makePose({0.3, 0.2, 0.0525});
  config.robots[0].sensors = {sensor("sole", SensorType::CONTACT, "body"), sensor("hat", SensorType::CONTACT, "hat")};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 1);
  const ContactReading sole = reading<ContactReading>(simulator.report(), 0);
  EXPECT_EQ(sole.contacts.size(), 4u);
  EXPECT_EQ(sole.link_body, simulator.robots()[0].bodies[0]);
  expectNear(sole.total.force, {0, 0, 3 * G}, 1e-5);
  // Torque about the link's origin: the weight's lever arm is 0.02 m along x.
  expectNear(sole.total.torque, {0, -0.02 * 3 * G, 0}, 1e-4);
  const ContactReading hat = reading<ContactReading>(simulator.report(), 1);
  EXPECT_TRUE(hat.contacts.empty());
  expectNear(hat.total.force, Vector3::Zero(), 0.0 + 1e-300);
}

TEST(MotorCurrentSensor, EffortOverTorqueConstant) {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  config.robots[0].gains["default"] = {1000, 0, 60};
  SensorConfig motors = sensor("motors", SensorType::MOTOR_CURRENT);
  motors.torque_constant = {{"default", 3}, {"hinge", 0.5}};
  config.robots[0].sensors = {motors};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.5);
  const MotorCurrentReading value = reading<MotorCurrentReading>(simulator.report(), 0);
  ASSERT_EQ(value.joints, std::vector<std::string>{"hinge"});
  EXPECT_EQ(value.efforts[0], simulator.report().joints[0].effort);
  EXPECT_DOUBLE_EQ(value.currents[0], value.efforts[0] / 0.5);
  std::string& urdf = config.robots[0].urdf_xml;
  urdf.insert(urdf.find("</robot>"),
              R"(<transmission name="t"><joint name="hinge"/><mechanicalReduction>40</mechanicalReduction></transmission>)");
  Simulator geared(config, model::UriResolver());
  stepFor(&geared, 0.5);
  EXPECT_DOUBLE_EQ(reading<MotorCurrentReading>(geared.report(), 0).currents[0], value.efforts[0] / (40 * 0.5));
}

/** A bar of 1 kg on a hinge, a ball 5 cm from it in the ground, so that friction locks it. */
std::string lockedBarUrdf() {
  return R"(<robot name="arm"><link name="base"/><link name="bar">
<inertial><origin xyz="0.25 0 0"/><mass value="1"/><inertia ixx="0.001" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0.05 0 0"/><geometry><sphere radius="0.05"/></geometry></collision></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="bar"/><axis xyz="0 1 0"/></joint></robot>)";
}

TEST(ForceTorqueSensor, WhatStandsLockedInTheGroundFeelsNoPushOfCorrectionsThatWereGivenUp) {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.environments = {ground()};
  config.robots = {robot("arm", lockedBarUrdf(), true)};
  config.robots[0].X_WR = makePose({0, 0, 0.0485});
  config.robots[0].sensors = {forceTorque("hinge", "hinge", "child", "parent_to_child")};
  Simulator simulator(config, model::UriResolver());
  for (int i = 0; i < 20; ++i) {
    const StepReport& report = simulator.step();
    EXPECT_EQ(report.contacts.size(), 1u);
    EXPECT_LT(report.bodies[0].w_WB.norm(), 1e-9);
    EXPECT_LT(reading<ForceTorqueReading>(report, 0).force.norm(), 1e-6);
    EXPECT_LT(forceOfWorld(report).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace blem_sim::sim
