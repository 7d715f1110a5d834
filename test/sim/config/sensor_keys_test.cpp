// Keys that sensors of several types have: frames, topics, constant biases; odometry; links that collide with their own robot.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <limits>
#include <set>
#include <string>
#include <vector>

#include "sim/simulation_scene.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

RobotConfig parsedRobot(const std::string& keys) {
  return parseConfig(YAML::Load("robots: [{name: a, urdf: a.urdf, " + keys + "}]"), "scene.yaml", "").robots[0];
}

TEST(SensorKeys, AreRead) {
  const auto sensors = parsedRobot(R"(sensors: [
    {name: o, type: odometry, link: l, pose: {xyz: [1, 2, 3]}, twist: world, frame_id: map, noise: {stddev: 0.1}},
    {name: f, type: force_torque, joint: j, frame_id: plate}, {name: t, type: tilt, link: l, frame_id: x}, {name: s, type: lidar, link: l, frame_id: y},
    {name: i, type: imu, link: l, frame_id: z, noise: {accel_bias: -1, gyro_bias: 2, accel_bias_spread: 3, gyro_bias_spread: 4}},
    {name: c, type: depth_camera, link: l, frame_id: w, topics: {image_raw: a, image: b, camera_info: c, points: d}}])")
                           .sensors;
  ASSERT_EQ(sensors.size(), 6u);
  EXPECT_EQ(sensors[0].type, SensorType::ODOMETRY);
  EXPECT_EQ(sensors[0].rate, 50);
  EXPECT_EQ(sensors[0].twist + sensors[0].frame_id, "worldmap");
  EXPECT_EQ(sensors[0].noise[0].stddev, 0.1);
  EXPECT_EQ(sensors[0].X_LS.translation(), Vector3(1, 2, 3));
  EXPECT_EQ(sensors[1].frame_id + sensors[2].frame_id + sensors[3].frame_id + sensors[4].frame_id + sensors[5].frame_id, "platexyzw");
  EXPECT_EQ((std::vector<double>{sensors[4].noise[0].bias, sensors[4].noise[1].bias, sensors[4].noise[0].bias_spread,
                                 sensors[4].noise[1].bias_spread}),
            (std::vector<double>{-1, 2, 3, 4}));
  const CameraTopics& topics = sensors[5].camera_topics;
  EXPECT_EQ(topics.image_raw + topics.image + topics.camera_info + topics.points, "abcd");
  EXPECT_EQ(parsedRobot("self_colliding_links: [b, c]").self_colliding_links, (std::set<std::string>{"b", "c"}));
  EXPECT_EQ(parsedRobot("namespace: n").self_collision, std::nullopt);
  EXPECT_EQ(parsedRobot("self_collision: false").self_collision, false);
}

TEST(SensorKeys, OfErrorsAreRead) {
  const auto sensors = parsedRobot(R"(sensors: [
    {name: f, type: force_torque, joint: j, delay: 0.1, saturation: {force: 4, torque: 3}, resolution: {force: 2, torque: 1}},
    {name: i, type: imu, link: l, delay: 0.2, saturation: {accel: 40, gyro: 30}, resolution: {accel: 20, gyro: 10}},
    {name: t, type: tilt, link: l, delay: 0.3, saturation: {angle: 0.4, gyro: .inf}, resolution: {angle: 0.2, gyro: 0}},
    {name: m, type: motor_current, delay: 1, saturation: {effort: 8}, resolution: {current: 7}}])")
                           .sensors;
  ASSERT_EQ(sensors.size(), 4u);
  std::vector<double> numbers;
  for (const SensorConfig& s : sensors)
    for (const double number : {s.delay, s.limits[0].saturation, s.limits[1].saturation, s.limits[0].resolution, s.limits[1].resolution})
      numbers.push_back(number);
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(numbers, (std::vector<double>{0.1, 4, 3, 2, 1, 0.2, 40, 30, 20, 10, 0.3, 0.4, inf, 0.2, 0, 1, inf, 8, 7, 0}));
}

TEST(SensorKeys, OfSolesAndOffsetsAreRead) {
  const auto sensors = parsedRobot(R"(sensors: [
    {name: s, type: contact_switch, link: l, threshold: 5, delay: 0.1, noise: {force_stddev: 2}},
    {name: c, type: centre_of_pressure, link: l, pose: {xyz: [1, 2, 3]}, frame_id: x, threshold: 6, noise: {position_bias: 1},
     saturation: {position: 0.1}, resolution: {position: 0.01}, delay: 0.2},
    {name: o, type: odometry, link: l, offset: {xyz: [4, 5, 6], rpy: [0, 0, 1]}},
    {name: f, type: force_torque, joint: j, frame: some_link}])")
                           .sensors;
  EXPECT_EQ(sensors[0].type, SensorType::CONTACT_SWITCH);
  EXPECT_EQ((std::vector<double>{sensors[0].threshold, sensors[0].delay, sensors[0].noise[0].stddev}), (std::vector<double>{5, 0.1, 2}));
  EXPECT_EQ(sensors[1].type, SensorType::CENTRE_OF_PRESSURE);
  EXPECT_EQ((std::vector<double>{sensors[1].threshold, sensors[1].delay, sensors[1].noise[0].bias, sensors[1].limits[0].saturation,
                                 sensors[1].limits[0].resolution}),
            (std::vector<double>{6, 0.2, 1, 0.1, 0.01}));
  EXPECT_EQ(sensors[1].X_LS.translation(), Vector3(1, 2, 3));
  EXPECT_TRUE(sensors[2].X_offset.isApprox(makePose({4, 5, 6}, {0, 0, 1}), 1e-15));
  EXPECT_EQ(sensors[3].frame, "some_link");
}

TEST(SensorKeys, OfNoiseAreRead) {
  const auto sensors = parsedRobot(R"(sensors: [
    {name: f, type: force_torque, joint: j, noise: {stddev: 5, torque_stddev: 1, force_bias: -2, torque_bias_spread: 3}},
    {name: t, type: tilt, link: l, noise: {angle_stddev: 1, gyro_bias_stddev: 2}},
    {name: m, type: motor_current, noise: {current_bias: 1, effort_stddev: 2}}])")
                           .sensors;
  std::vector<double> numbers;
  for (const SensorConfig& sensor : sensors)
    for (const QuantityNoise& noise : sensor.noise)
      for (const double number : {noise.stddev, noise.bias_stddev, noise.bias, noise.bias_spread}) numbers.push_back(number);
  EXPECT_EQ(numbers, (std::vector<double>{5, 0, -2, 0, 1, 0, 0, 3, 1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0}));
}

TEST(Rates, MayBeOff) {
  for (const char* word : {"off", ".off", "Off", "false", "'off'"}) {
    const std::string off = word;
    const SimulationConfig config = parseConfig(
        YAML::Load("{clock_rate: " + off + ", joint_state_rate: " + off + ", tf_rate: " + off + ", odom_rate: " + off +
                   ", contact_rate: " + off + ", marker_rate: " + off + ", link_states_rate: " + off + ", step_report_rate: " + off + "}"),
        "scene.yaml", "");
    const PublishRates& r = config.rates;
    for (const double rate : {r.clock, r.joint_state, r.tf, r.odom, r.contact, r.markers, r.link_states, r.step_report})
      EXPECT_EQ(rate, RATE_OFF) << off;
    const RobotConfig robot =
        parsedRobot("sensors: [{name: t, type: tilt, link: l, rate: " + off + "}], controllers: [{name: c, state_publish_rate: " + off +
                    ", action_monitor_rate: " + off + "}]");
    EXPECT_EQ(robot.sensors[0].rate, RATE_OFF);
    EXPECT_EQ(robot.controllers->at(0).state_publish_rate, RATE_OFF);
    EXPECT_EQ(robot.controllers->at(0).action_monitor_rate, RATE_OFF);
  }
  EXPECT_TRUE(isOneLineWith(refusal([] { parseConfig(YAML::Load("tf_rate: never"), "scene.yaml", ""); }), {"tf_rate", "or off", "never"}));
  EXPECT_TRUE(isOneLineWith(refusal([] { parseConfig(YAML::Load("tf_rate: -1"), "scene.yaml", ""); }), {"tf_rate", "or off"}));
}

TEST(RobotKeys, OfFramesAndOdometryAreRead) {
  const RobotConfig given =
      parsedRobot("tf_prefix: left, publish_tf: false, odom: {topic: truth, frame: map, pose: {xyz: [1, 2, 3], rpy: [0, 0, 1.5]}}");
  EXPECT_EQ(given.tf_prefix + given.odom.topic + given.odom.frame, "lefttruthmap");
  EXPECT_FALSE(given.publish_tf);
  EXPECT_TRUE(given.odom.X_WF.isApprox(makePose({1, 2, 3}, {0, 0, 1.5}), 1e-15));
  const RobotConfig none = parsedRobot("namespace: n");
  EXPECT_EQ(none.tf_prefix + none.odom.topic + none.odom.frame, "odomworld");
  EXPECT_TRUE(none.publish_tf);
  EXPECT_TRUE(none.odom.X_WF.isApprox(Pose::Identity(), 0));
}

TEST(SensorKeys, AreRefusedInOneLine) {
  for (const auto& [keys, word] :
       {std::make_pair("sensors: [{name: o, type: odometry, link: l, twist: up}]", "twist"),
        std::make_pair("sensors: [{name: o, type: odometry}]", "link"),
        std::make_pair("sensors: [{name: c, type: contact, link: l, frame_id: x}]", "frame_id"),
        std::make_pair("sensors: [{name: i, type: imu, link: l, noise: {gyro_bias_spread: -1}}]", "gyro_bias_spread"),
        std::make_pair("sensors: [{name: i, type: imu, link: l, noise: {gyro_stddev: 1.0e+300}}]", "from 0 to 1e7"),
        std::make_pair("sensors: [{name: i, type: imu, link: l, noise: {gyro_bias: -1.0e+8}}]", "from -1e7 to 1e7"),
        std::make_pair("sensors: [{name: s, type: lidar, link: l, noise: {stddev: 1.0e+8}}]", "from 0 to 1e7"),
        std::make_pair("sensors: [{name: t, type: tilt, link: l, delay: 1.5}]", "delay"),
        std::make_pair("sensors: [{name: s, type: contact_switch}]", "link"),
        std::make_pair("sensors: [{name: s, type: contact_switch, link: l, threshold: -1}]", "threshold"),
        std::make_pair("sensors: [{name: s, type: contact_switch, link: l, frame_id: x}]", "frame_id"),
        std::make_pair("sensors: [{name: c, type: centre_of_pressure, link: l, noise: {force_stddev: 1}}]", "position_"),
        std::make_pair("sensors: [{name: c, link: l}]", "centre_of_pressure"),
        std::make_pair("sensors: [{name: t, type: tilt, link: l, noise: {stddev: 1}}]", "noise.stddev"),
        std::make_pair("sensors: [{name: m, type: motor_current, noise: {effort_bias_stddev: -1}}]", "effort_bias_stddev"),
        std::make_pair("sensors: [{name: t, type: tilt, link: l, saturation: {angle: 0}}]", "saturation.angle"),
        std::make_pair("sensors: [{name: t, type: tilt, link: l, resolution: {angle: -1}}]", "resolution.angle"),
        std::make_pair("sensors: [{name: t, type: tilt, link: l, saturation: {force: 1}}]", "force"),
        std::make_pair("sensors: [{name: t, type: tilt, link: l, saturation: {gyro: 1}, resolution: {gyro: 2}}]", "resolution.gyro"),
        std::make_pair("sensors: [{name: c, type: contact, link: l, delay: 0.1}]", "delay"),
        std::make_pair("odom: {topic: ''}", "odom.topic"),
        std::make_pair("odom: {frame: ''}", "odom.frame"),
        std::make_pair("odom: {child_frame: base}", "odom.child_frame"),
        std::make_pair("publish_tf: never", "publish_tf"),
        std::make_pair("self_colliding_links: foot", "self_colliding_links"),
        std::make_pair("self_colliding_links: [[foot]]", "self_colliding_links")})
    EXPECT_TRUE(isOneLineWith(refusal([&, k = keys] { parsedRobot(k); }), {word})) << keys;
}

}  // namespace
}  // namespace blem_sim::sim
