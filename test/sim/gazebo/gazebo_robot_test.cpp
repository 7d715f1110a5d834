// <gazebo> blocks as a robot's surfaces and sensors; what is told of the rest.
#include <gtest/gtest.h>

#include <limits>

#include "sim/gazebo/described_robot.h"

namespace blem_sim::sim {
namespace {

constexpr double UNLIMITED = std::numeric_limits<double>::infinity();

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
                "<gazebo>" + plugin("ackermann_drive", "<wheel>w</wheel>", "drive") + "</gazebo>");
  for (const char* words :
       {"'leg' <glitter>", "'leg' <fizz/depth>", "sensor 'ping' of type 'sonar'", "sensor 'eye' of type 'camera'", "sensor 's' <aura>",
        "plugin 'p' of type 'libgazebo_ros_bumper.so' in sensor 's'", "plugin 'drive' of type 'libgazebo_ros_ackermann_drive.so'"})
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
