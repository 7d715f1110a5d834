// <gazebo> blocks of sensors: what becomes of them, and what is told of the rest.
#include <gtest/gtest.h>

#include <limits>

#include "sim/gazebo/described_robot.h"

namespace blem_sim::sim {
namespace {

TEST(GazeboSensor, ForceTorqueByPluginAndBySensor) {
  const GazeboRobot robot =
      described("<gazebo>" +
                plugin("ft_sensor",
                       "<jointName>flange</jointName><topicName>flange/wrench</topicName><updateRate>100</updateRate>"
                       "<gaussianNoise>0.5</gaussianNoise>",
                       "ft") +
                "</gazebo>" +
                onLink(sensorBlock("force_torque",
                                   "<update_rate>30</update_rate><force_torque><frame>parent</frame><measure_direction>"
                                   "parent_to_child</measure_direction></force_torque>") +
                           sensorBlock("force_torque", "", "plain"),
                       "hip"));
  ASSERT_EQ(robot.config.sensors.size(), 3u) << allNotes(robot);
  const SensorConfig &ft = robot.config.sensors[0], &hip = robot.config.sensors[1], &plain = robot.config.sensors[2];
  EXPECT_EQ(ft.type, SensorType::FORCE_TORQUE);
  EXPECT_EQ(ft.name + " " + ft.joint + " " + ft.topic + " " + ft.frame + " " + ft.measure, "ft flange flange/wrench child child_to_parent");
  EXPECT_EQ(ft.rate, 100);
  for (const QuantityNoise& noise : ft.noise) EXPECT_EQ(noise.stddev, 0.5);
  EXPECT_EQ(hip.joint + " " + hip.frame + " " + hip.measure, "hip parent parent_to_child");
  EXPECT_EQ(hip.rate, 30);
  EXPECT_EQ(plain.frame + " " + plain.measure, "child child_to_parent");
  EXPECT_EQ(told(robot, "sensors of its <gazebo> blocks: ft (force_torque of 'flange' on /flange/wrench)"), 1) << allNotes(robot);
}

TEST(GazeboSensor, ImuNoiseInBothLayouts) {
  const auto axes = [](const std::string& noise) { return "<x>" + noise + "</x><y>" + noise + "</y><z>" + noise + "</z>"; };
  const std::string noise =
      "<noise type=\"gaussian\"><mean>0.1</mean><stddev>0.2</stddev><bias_mean>0.3</bias_mean><bias_stddev>0.4"
      "</bias_stddev></noise>";
  const std::string later = "<imu><angular_velocity>" + axes("<noise type=\"gaussian\"><stddev>0.01</stddev></noise>") +
                            "</angular_velocity><linear_acceleration>" + axes(noise) + "</linear_acceleration></imu>";
  const std::string former =
      "<imu><noise><type>gaussian</type><rate><mean>0</mean><stddev>0.01</stddev></rate><accel><mean>0.1</mean><stddev>0.2"
      "</stddev><bias_mean>0.3</bias_mean><bias_stddev>0.4</bias_stddev></accel></noise></imu>";
  for (const std::string& layout : {later, former}) {
    const GazeboRobot robot = described(onLink(sensorBlock("imu", layout + "<pose>1 2 3 0 0 0.5</pose><update_rate>200</update_rate>")));
    ASSERT_EQ(robot.config.sensors.size(), 1u);
    const SensorConfig& imu = robot.config.sensors[0];
    EXPECT_EQ(robot.notes.size(), 1u) << allNotes(robot);
    EXPECT_EQ(imu.link, "leg");
    EXPECT_EQ(imu.rate, 200);
    EXPECT_TRUE(imu.X_LS.isApprox(makePose({1, 2, 3}, {0, 0, 0.5})));
    EXPECT_EQ(imu.noise[1].stddev, 0.01);
    EXPECT_EQ(imu.noise[0].stddev, 0.2);
    EXPECT_DOUBLE_EQ(imu.noise[0].bias, 0.4);
    EXPECT_EQ(imu.noise[0].bias_spread, 0.4);
  }
  const GazeboRobot uneven =
      described(onLink(sensorBlock("imu", "<imu><angular_velocity><x><noise><stddev>0.3</stddev></noise></x></angular_velocity></imu>")));
  EXPECT_EQ(uneven.config.sensors[0].noise[1].stddev, 0.3);
  EXPECT_EQ(told(uneven, "different noise"), 1);
}

TEST(GazeboSensor, NoiseThatIsNotGaussianIsLeftOut) {
  const auto ray = [](const std::string& type) {
    return described(onLink(sensorBlock("ray", "<ray><scan><horizontal><samples>1</samples></horizontal></scan><noise><type>" + type +
                                                   "</type><stddev>0.1</stddev></noise></ray>")));
  };
  EXPECT_EQ(ray("gaussian").config.sensors.at(0).rays.stddev, 0.1);
  EXPECT_EQ(ray("none").config.sensors.at(0).rays.stddev, 0);
  EXPECT_EQ(told(ray("none"), "test.urdf"), 0);
  EXPECT_EQ(ray("pink").config.sensors.at(0).rays.stddev, 0);
  EXPECT_EQ(told(ray("pink"), "<ray/noise/type>: 'pink' is not known"), 1);
}

TEST(GazeboSensor, ImuPlugins) {
  const std::string values =
      "<topicName>data</topicName><bodyName>tool</bodyName><gaussianNoise>0.3</gaussianNoise><xyzOffset>0 0 1</xyzOffset>"
      "<rpyOffset>0 0 1</rpyOffset><frameName>/tool_imu</frameName>";
  const GazeboRobot robot = described(
      "<gazebo>" + plugin("imu", values + "<updateRate>50</updateRate><serviceName>calibrate</serviceName>") + "</gazebo>" +
      onLink(sensorBlock(
          "imu", "<update_rate>100</update_rate>" +
                     plugin("imu_sensor", "<topicName>b</topicName><bodyName>anywhere</bodyName><updateRateHZ>400</updateRateHZ>"))));
  ASSERT_EQ(robot.config.sensors.size(), 2u) << allNotes(robot);
  const SensorConfig &model = robot.config.sensors[0], &inside = robot.config.sensors[1];
  EXPECT_EQ(model.name + " " + model.link + " " + model.topic + " " + model.frame_id, "p tool data tool_imu");
  EXPECT_EQ(model.rate, 50);
  EXPECT_EQ(model.noise[0].stddev, 0.3);
  EXPECT_EQ(model.noise[1].stddev, 0.3);
  EXPECT_TRUE(model.X_LS.isApprox(makePose({0, 0, 1}, {0, 0, 1})));
  EXPECT_EQ(inside.name + " " + inside.link + " " + inside.topic, "s leg b");
  EXPECT_EQ(inside.rate, 100) << "the slower one";
}

TEST(GazeboSensor, BumperAndP3d) {
  const GazeboRobot robot = described(
      onLink(sensorBlock("contact", "<contact><collision>leg_collision</collision></contact>" +
                                        plugin("bumper", "<bumperTopicName>bump</bumperTopicName><frameName>world</frameName>"))) +
      "<gazebo>" +
      plugin("p3d", "<bodyName>tool</bodyName><topicName>truth</topicName><frameName>map</frameName><gaussianNoise>0.01</gaussianNoise>") +
      plugin("joint_state_publisher", "<jointName>hip</jointName>") +
      plugin("p3d", "<bodyName>leg</bodyName><topicName>odom</topicName><xyzOffset>1 2 3</xyzOffset><rpyOffset>0 0 0.5</rpyOffset>",
             "second") +
      "</gazebo>");
  ASSERT_EQ(robot.config.sensors.size(), 3u) << allNotes(robot);
  const SensorConfig &bumper = robot.config.sensors[0], &truth = robot.config.sensors[1], &second = robot.config.sensors[2];
  EXPECT_EQ(bumper.type, SensorType::CONTACT);
  EXPECT_EQ(bumper.topic + bumper.frame_id, "bump");
  EXPECT_EQ(truth.type, SensorType::ODOMETRY);
  EXPECT_EQ(truth.link + " " + truth.topic + " " + truth.frame_id + " " + truth.twist, "tool truth map world");
  EXPECT_EQ(truth.noise[0].stddev, 0.01);
  EXPECT_TRUE(truth.X_offset.isApprox(Pose::Identity(), 0));
  EXPECT_TRUE(second.X_offset.isApprox(makePose({1, 2, 3}, {0, 0, 0.5}), 1e-15));
  EXPECT_EQ(second.topic, "") << "odom is the robot's own";
  EXPECT_EQ(told(robot, "its topic odom is the robot's own"), 1) << allNotes(robot);
  EXPECT_EQ(told(robot, "without effect here: jointName"), 1) << allNotes(robot);
}

TEST(GazeboSensor, RayAndDepth) {
  const GazeboRobot robot = described(onLink(
      sensorBlock(
          "ray",
          "<ray><scan><horizontal><samples>100</samples><resolution>0.5</resolution><min_angle>-1.5</min_angle><max_angle>1</max_angle>"
          "</horizontal><vertical><samples>4</samples><min_angle>-0.2</min_angle><max_angle>0.3</max_angle></vertical></scan>"
          "<range><min>0.2</min><max>12</max></range><noise><type>gaussian</type><stddev>0.03</stddev></noise></ray>" +
              plugin("block_laser", "<topicName>cloud</topicName><frameName>leg</frameName><gaussianNoise>0.04</gaussianNoise>"),
          "scan") +
      sensorBlock(
          "depth",
          "<camera name=\"c\"><horizontal_fov>1.2</horizontal_fov><image><width>64</width><height>48</height></image><clip><near>0.05"
          "</near><far>8</far></clip></camera>" +
              plugin("openni_kinect",
                     "<cameraName>/cam</cameraName><distortionK1>0.00000001</distortionK1><CxPrime>320.5</CxPrime><depthImageTopicName>d</"
                     "depthImageTopicName><depthImageInfoTopicName>/i"
                     "</depthImageInfoTopicName><pointCloudTopicName>/p</pointCloudTopicName><pointCloudCutoff>0.4</pointCloudCutoff>"
                     "<frameName>optical</frameName><updateRate>15</updateRate>"),
          "eye")));
  ASSERT_EQ(robot.config.sensors.size(), 2u) << allNotes(robot);
  const SensorConfig &scan = robot.config.sensors[0], &eye = robot.config.sensors[1];
  EXPECT_EQ(robot.notes.size(), 1u) << allNotes(robot);
  EXPECT_EQ(scan.type, SensorType::LIDAR);
  EXPECT_EQ(scan.topic + " " + scan.frame_id, "cloud leg");
  EXPECT_EQ(scan.rays.beams, 50);
  EXPECT_EQ(scan.rays.layers, 4);
  EXPECT_EQ(scan.rays.first_angle, -1.5);
  EXPECT_EQ(scan.rays.last_angle, 1);
  EXPECT_EQ(scan.rays.lowest_angle, -0.2);
  EXPECT_EQ(scan.rays.highest_angle, 0.3);
  EXPECT_EQ(scan.rays.nearest, 0.2);
  EXPECT_EQ(scan.rays.farthest, 12);
  EXPECT_DOUBLE_EQ(scan.rays.stddev, 0.05);
  EXPECT_EQ(scan.rate, 40);
  EXPECT_EQ(eye.type, SensorType::DEPTH_CAMERA);
  EXPECT_EQ(eye.rays.width, 64);
  EXPECT_EQ(eye.rays.height, 48);
  EXPECT_EQ(eye.rays.hfov, 1.2);
  EXPECT_EQ(eye.rays.nearest, 0.4);
  EXPECT_EQ(eye.rays.farthest, 8);
  EXPECT_EQ(eye.rate, 15);
  EXPECT_EQ(eye.topic + " " + eye.camera_topics.image_raw + " " + eye.camera_topics.camera_info + " " + eye.camera_topics.points + " " +
                eye.frame_id,
            "cam cam/d /i /p optical");
}

TEST(GazeboSensor, TheConfigurationBeatsTheUrdf) {
  RobotConfig config;
  config.name_space = "mine";
  config.sensors.resize(2);
  config.sensors[0].name = "s";
  config.sensors[0].rate = 7;
  config.sensors[1].name = "other";
  config.sensors[1].topic = "data";
  const GazeboRobot robot =
      described(onLink(sensorBlock("imu", "<update_rate>100</update_rate>") +
                       sensorBlock("imu", plugin("imu_sensor", "<topicName>/mine/data</topicName>"), "t") +
                       sensorBlock("imu", plugin("imu_sensor", "<topicName>free</topicName><robotNamespace>theirs</robotNamespace>"), "u")),
                config);
  ASSERT_EQ(robot.config.sensors.size(), 3u) << allNotes(robot);
  EXPECT_EQ(robot.config.sensors[0].rate, 7);
  EXPECT_EQ(robot.config.sensors[2].topic, "free") << "in the robot's own name space, not in the plugin's";
  EXPECT_EQ(described(onLink(sensorBlock("imu", plugin("imu_sensor", "<topicName>free</topicName><robotNamespace>/theirs</robotNamespace>"),
                                         "u")))
                .config.sensors.at(0)
                .topic,
            "/theirs/free");
}

TEST(GazeboSensor, NamesAndTopicsAreKeptApart) {
  const auto ft = [](const std::string& joint, const std::string& topic) {
    return plugin("ft_sensor", "<jointName>" + joint + "</jointName><topicName>" + topic + "</topicName>", "left ft");
  };
  const GazeboRobot robot =
      described("<gazebo>" + ft("hip", "a") + ft("flange", "b") + ft("hip", "c") + ft("hip", "d") + ft("flange", "a") + "</gazebo>");
  ASSERT_EQ(robot.config.sensors.size(), 3u) << allNotes(robot);
  EXPECT_EQ(robot.config.sensors[0].name, "left_ft");
  EXPECT_EQ(robot.config.sensors[1].name, "left_ft_flange");
  EXPECT_EQ(robot.config.sensors[2].name, "left_ft_hip");
  EXPECT_EQ(told(robot, "is there twice"), 1) << allNotes(robot);
  EXPECT_EQ(told(robot, "sensor 'left_ft' has its topic a"), 1) << allNotes(robot);
}

TEST(GazeboSensor, NoMoreThanAThousand) {
  std::string many;
  for (int i = 0; i < 1100; ++i) many += sensorBlock("imu", "", "s" + std::to_string(i));
  const GazeboRobot robot = described(onLink(many));
  EXPECT_EQ(robot.config.sensors.size(), 1000u);
  EXPECT_EQ(told(robot, "80 more faults"), 1) << allNotes(robot);
}

TEST(GazeboSensor, OneWithoutAPluginLeavesItsTopicToOneThatHasAPlugin) {
  const GazeboRobot robot = described(
      onLink(sensorBlock("imu", "<update_rate>7</update_rate>", "imu")) + "<gazebo>" +
      plugin("imu", "<bodyName>tool</bodyName><topicName>imu</topicName><updateRate>50</updateRate>", "imu_plugin") + "</gazebo>");
  ASSERT_EQ(robot.config.sensors.size(), 1u) << allNotes(robot);
  EXPECT_EQ(robot.config.sensors[0].name, "imu_plugin");
  EXPECT_EQ(robot.config.sensors[0].link, "tool");
  EXPECT_EQ(robot.config.sensors[0].rate, 50);
  EXPECT_EQ(told(robot, "sensor 'imu': sensor 'imu_plugin' has its topic imu; it is left out"), 1) << allNotes(robot);
}

TEST(GazeboSensor, AWholeTurnMayBeRounded) {
  const GazeboRobot robot = described(onLink(
      sensorBlock("ray",
                  "<ray><scan><horizontal><samples>360</samples><min_angle>0.0</min_angle><max_angle>6.28319</max_angle></horizontal>"
                  "<vertical><samples>3</samples><min_angle>-1.5708</min_angle><max_angle>1.5708</max_angle></vertical></scan></ray>")));
  ASSERT_EQ(robot.config.sensors.size(), 1u) << allNotes(robot);
  EXPECT_EQ(robot.config.sensors[0].rays.last_angle, 6.28319);
  EXPECT_TRUE(described(onLink(sensorBlock("ray",
                                           "<ray><scan><horizontal><samples>9</samples><min_angle>0</min_angle>"
                                           "<max_angle>6.3</max_angle></horizontal></scan></ray>")))
                  .config.sensors.empty());
}

}  // namespace
}  // namespace blem_sim::sim
