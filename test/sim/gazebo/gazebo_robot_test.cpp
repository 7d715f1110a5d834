// <gazebo> blocks as a robot's surfaces and sensors; what is told of the rest.
#include "gazebo/gazebo_robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "blem_sim/model/loaders.h"

namespace blem_sim::sim {
namespace {

constexpr double UNLIMITED = std::numeric_limits<double>::infinity();

/** A robot of two links and three joints with these blocks. */
GazeboRobot described(const std::string& blocks, const RobotConfig& config = {}) {
  const auto joint = [](const std::string& name, const std::string& type, const std::string& child) {
    return "<link name=\"" + child + "\"/><joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"base\"/><child link=\"" +
           child + "\"/></joint>";
  };
  const std::string xml = "<robot name=\"r\"><link name=\"base\"/>" + joint("hip", "continuous", "leg") + joint("flange", "fixed", "tool") +
                          joint("drift", "planar", "sled") + blocks + "</robot>";
  return withGazeboBlocks(config, model::loadUrdf(xml, "test.urdf", model::UriResolver()));
}

std::string onLink(const std::string& inside, const std::string& link = "leg") {
  return "<gazebo reference=\"" + link + "\">" + inside + "</gazebo>";
}

std::string sensorBlock(const std::string& type, const std::string& inside, const std::string& name = "s") {
  return "<sensor type=\"" + type + "\" name=\"" + name + "\">" + inside + "</sensor>";
}

std::string plugin(const std::string& file, const std::string& inside, const std::string& name = "p") {
  return "<plugin name=\"" + name + "\" filename=\"libgazebo_ros_" + file + ".so\">" + inside + "</plugin>";
}

/** The notes with these words in them. */
int told(const GazeboRobot& robot, const std::string& words) {
  const auto has = [&](const std::string& note) { return note.find(words) != std::string::npos && note.find('\n') == std::string::npos; };
  return static_cast<int>(std::count_if(robot.notes.begin(), robot.notes.end(), has));
}

std::string allNotes(const GazeboRobot& robot) {
  std::string all;
  for (const std::string& note : robot.notes) all += note + "\n";
  return all;
}

TEST(GazeboSurface, FrictionAndMu2) {
  const GazeboRobot robot = described(onLink("<mu1>0.9</mu1><mu2>0.9</mu2>") + onLink("<mu1>0.7</mu1><mu2>0.2</mu2>", "base") +
                                      onLink("<mu2 value=\"0.3\"/>", "tool") + onLink("<mu1>0.6</mu1>"));
  EXPECT_EQ(robot.config.described_links.at("leg").friction, 0.6) << "the last one counts";
  EXPECT_EQ(robot.config.described_links.at("base").friction, 0.7);
  EXPECT_EQ(robot.config.described_links.at("tool").friction, 0.3);
  EXPECT_EQ(told(robot, "<mu2> other than <mu1>, which friction of all directions is taken from: base"), 1) << allNotes(robot);
  EXPECT_EQ(robot.notes.size(), 1u) << allNotes(robot);
}

TEST(GazeboSurface, StiffnessIsRigidFromAMillionOn) {
  const auto surface = [](const std::string& values) { return described(onLink(values)).config.described_links.at("leg"); };
  EXPECT_EQ(surface("<kp>20000</kp><kd>300</kd>").stiffness, 20000);
  EXPECT_EQ(surface("<kp>20000</kp><kd>300</kd>").damping, 300);
  EXPECT_EQ(surface("<kp>20000</kp>").damping, 1);
  EXPECT_EQ(surface("<kp>1000000.0</kp><kd>1.0</kd>").stiffness, UNLIMITED);
  EXPECT_EQ(surface("<kp>1e+12</kp><kd>1.0</kd>").damping, UNLIMITED);
  EXPECT_FALSE(surface("<kd>5</kd>").stiffness);
  EXPECT_FALSE(surface("<kd>5</kd>").damping);
}

TEST(GazeboSurface, SelfCollision) {
  EXPECT_EQ(described(onLink("<selfCollide>true</selfCollide>")).config.self_colliding_links, std::set<std::string>{"leg"});
  EXPECT_TRUE(described(onLink("<selfCollide>false</selfCollide>")).config.self_colliding_links.empty());
  EXPECT_EQ(described("<gazebo><self_collide>1</self_collide></gazebo>").config.self_collision, true);
  EXPECT_EQ(described("<gazebo><self_collide>0</self_collide></gazebo>").config.self_collision, std::nullopt);
  RobotConfig config;
  config.self_collision = false;
  EXPECT_EQ(described("<gazebo><self_collide>1</self_collide></gazebo>", config).config.self_collision, false);
}

TEST(GazeboSurface, WhatCannotBeSaysSo) {
  const GazeboRobot robot = described(
      onLink("<turnGravityOff>true</turnGravityOff>") + onLink("<gravity>0</gravity>", "tool") + onLink("<gravity>1</gravity>", "base") +
      onLink("<minDepth>0.001</minDepth><maxVel>0.1</maxVel><material>Gazebo/Red</material>") +
      onLink("<provideFeedback>1</provideFeedback><implicitSpringDamper>1</implicitSpringDamper><preserveFixedJoint>1"
             "</preserveFixedJoint><springStiffness>0</springStiffness>",
             "hip") +
      "<gazebo><static>true</static></gazebo>");
  EXPECT_EQ(robot.config.weightless_links, (std::set<std::string>{"leg", "tool"}));
  EXPECT_EQ(told(robot, "without effect here: minDepth, maxVel, provideFeedback, implicitSpringDamper;"), 1) << allNotes(robot);
  EXPECT_EQ(told(robot, "<static>: "), 1) << allNotes(robot);
  EXPECT_EQ(robot.notes.size(), 2u) << allNotes(robot);
  EXPECT_EQ(told(described(onLink("<springStiffness>3</springStiffness>", "hip")), "not read: 'hip' <springStiffness>"), 1);
}

TEST(GazeboBlocks, WhatIsNotUnderstoodIsListedInOneLine) {
  const GazeboRobot robot =
      described(onLink("<glitter>1</glitter><glitter>2</glitter><fizz><depth>1</depth></fizz>" + sensorBlock("sonar", "", "ping") +
                       sensorBlock("camera", plugin("camera", ""), "eye") + sensorBlock("imu", "<aura/>" + plugin("bumper", ""))) +
                "<gazebo>" + plugin("planar_move", "<wheel>w</wheel>", "drive") + "</gazebo>");
  for (const char* words :
       {"'leg' <glitter>", "'leg' <fizz/depth>", "sensor 'ping' of type 'sonar'", "sensor 'eye' of type 'camera'", "sensor 's' <aura>",
        "plugin 'p' of type 'libgazebo_ros_bumper.so' in sensor 's'", "plugin 'drive' of type 'libgazebo_ros_planar_move.so'"})
    EXPECT_EQ(told(robot, words), 1) << words << " in " << allNotes(robot);
  EXPECT_EQ(told(robot, "<gazebo>: not read"), 1);
  EXPECT_EQ(robot.notes.size(), 2u) << "and the list of sensors: " << allNotes(robot);
  std::string many;
  for (int i = 0; i < 200; ++i) many += "<x" + std::to_string(i) + "/>";
  EXPECT_EQ(told(described(onLink(many)), "and 180 more"), 1);
}

struct BadBlock {
  const char *name, *block, *words;
};

class BadGazeboBlock : public testing::TestWithParam<BadBlock> {};

TEST_P(BadGazeboBlock, IsLeftOutInOneLineWithFileElementAndCure) {
  const GazeboRobot robot = described(GetParam().block);
  EXPECT_EQ(told(robot, "test.urdf: "), 1) << allNotes(robot);
  EXPECT_EQ(told(robot, GetParam().words), 1) << allNotes(robot);
  EXPECT_EQ(told(robot, "left out"), 1) << allNotes(robot);
}

INSTANTIATE_TEST_SUITE_P(
    Rows, BadGazeboBlock,
    testing::Values(
        BadBlock{"word", "<gazebo reference=\"leg\"><mu1>slippery</mu1></gazebo>", "'leg': <mu1>: 'slippery' is not a number"},
        BadBlock{"nan", "<gazebo reference=\"leg\"><kp>nan</kp></gazebo>", "<kp>: 'nan'"},
        BadBlock{"huge", "<gazebo reference=\"leg\"><kp>1e999</kp></gazebo>", "<kp>: '1e999'"},
        BadBlock{"negative", "<gazebo reference=\"leg\"><mu1>-1</mu1></gazebo>", "<mu1>: is -1; it is left out: give a finite number"},
        BadBlock{"zero_kp", "<gazebo reference=\"leg\"><kp>0</kp></gazebo>", "<kp>: is 0"},
        BadBlock{"no_bool", "<gazebo reference=\"leg\"><selfCollide>maybe</selfCollide></gazebo>", "'maybe' is neither true nor false"},
        BadBlock{"nowhere", "<gazebo reference=\"knee\"><mu1>1</mu1></gazebo>",
                 "<gazebo reference=\"knee\">: there is no such link or joint"},
        BadBlock{"pose", "<gazebo reference=\"leg\"><sensor type=\"imu\" name=\"s\"><pose>1 2 3</pose></sensor></gazebo>",
                 "sensor 's': <pose>: '1 2 3' is not 6 numbers"},
        BadBlock{"on_joint", "<gazebo reference=\"hip\"><sensor type=\"imu\" name=\"s\"/></gazebo>", "there is no link 'hip'"},
        BadBlock{"on_link", "<gazebo reference=\"leg\"><sensor type=\"force_torque\" name=\"s\"/></gazebo>", "there is no joint 'leg'"},
        BadBlock{"no_joint",
                 "<gazebo><plugin name=\"p\" filename=\"libgazebo_ros_ft_sensor.so\"><jointName>hipp</jointName></plugin></gazebo>",
                 "there is no joint 'hipp' (the nearest is 'hip')"},
        BadBlock{"planar", "<gazebo reference=\"drift\"><sensor type=\"force_torque\" name=\"s\"/></gazebo>", "carries no wrench"},
        BadBlock{
            "direction",
            "<gazebo reference=\"hip\"><sensor type=\"force_torque\" name=\"s\"><force_torque><measure_direction>up</measure_direction>"
            "</force_torque></sensor></gazebo>",
            "<force_torque/measure_direction>: 'up' is not known"},
        BadBlock{"rays",
                 "<gazebo reference=\"leg\"><sensor type=\"ray\" name=\"s\"><ray><scan><horizontal><samples>1e9</samples><min_angle>-1"
                 "</min_angle><max_angle>1</max_angle></horizontal></scan></ray></sensor></gazebo>",
                 "sensor 's': its beams"},
        BadBlock{"half_ray",
                 "<gazebo reference=\"leg\"><sensor type=\"ray\" name=\"s\"><ray><scan><horizontal><samples>2.5</samples><min_angle>-1"
                 "</min_angle><max_angle>1</max_angle></horizontal></scan></ray></sensor></gazebo>",
                 "is 2.5"},
        BadBlock{"outside", "<gazebo><plugin name=\"p\" filename=\"libgazebo_ros_laser.so\"/></gazebo>", "stands outside of a <sensor>"},
        BadBlock{"topic",
                 "<gazebo><plugin name=\"p\" filename=\"libgazebo_ros_p3d.so\"><bodyName>leg</bodyName><topicName>a "
                 "b</topicName></plugin></gazebo>",
                 "'a b' is no ROS topic"},
        BadBlock{"shifted",
                 "<gazebo><plugin name=\"p\" filename=\"libgazebo_ros_p3d.so\"><bodyName>leg</bodyName><xyzOffset>1 0"
                 "</xyzOffset></plugin></gazebo>",
                 "<xyzOffset>: '1 0' is not 3 numbers"},
        BadBlock{"relative",
                 "<gazebo><plugin name=\"p\" "
                 "filename=\"libgazebo_ros_p3d.so\"><bodyName>leg</bodyName><frameName>base</frameName></plugin></gazebo>",
                 "not in link 'base'"},
        BadBlock{"name_space",
                 "<gazebo><plugin name=\"p\" filename=\"libgazebo_ros_control.so\"><robotNamespace>/r2</robotNamespace></plugin></gazebo>",
                 "<robotNamespace>: '/r2' is not where"}),
    [](const testing::TestParamInfo<BadBlock>& info) { return std::string(info.param.name); });

TEST(GazeboBlocks, LongWordsAreCut) {
  const GazeboRobot robot = described(onLink("<mu1>" + std::string(900, 'x') + "</mu1>"));
  ASSERT_EQ(robot.notes.size(), 1u);
  EXPECT_LT(robot.notes[0].size(), 400u);
}

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

TEST(GazeboMimic, APluginNeedsTheMimicOfItsJoint) {
  const auto robot = [](const std::string& mimic, const std::string& inside) {
    const std::string xml =
        "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>"
        "<joint name=\"lead\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint>"
        "<joint name=\"follow\" type=\"continuous\"><parent link=\"a\"/><child link=\"c\"/>" +
        mimic + "</joint><gazebo><plugin name=\"m\" filename=\"libroboticsgroup_gazebo_mimic_joint_plugin.so\">" + inside +
        "</plugin></gazebo></robot>";
    return withGazeboBlocks({}, model::loadUrdf(xml, "test.urdf", model::UriResolver()));
  };
  const std::string asked = "<joint>lead</joint><mimicJoint>follow</mimicJoint><multiplier>-0.5</multiplier><hasPID/>";
  EXPECT_EQ(allNotes(robot("<mimic joint=\"lead\" multiplier=\"-0.5\"/>", asked)),
            "<gazebo>: without effect here: hasPID; docs/gazebo_urdf.md says why\n");
  EXPECT_EQ(told(robot("", asked), "has none: write <mimic joint=\"lead\" multiplier=\"-0.5\" offset=\"0\"/> into it"), 1);
  EXPECT_EQ(told(robot("<mimic joint=\"lead\"/>", asked), "'follow' follows as its <mimic> says, and it has another one"), 1);
  EXPECT_EQ(told(robot("", "<joint>lead</joint><mimicJoint>folow</mimicJoint>"), "the nearest is 'follow'"), 1);
}

}  // namespace
}  // namespace blem_sim::sim
