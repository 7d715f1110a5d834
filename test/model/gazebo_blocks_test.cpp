// <gazebo> blocks as texts: paths, attributes, inner blocks, bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "blem_sim/model/loaders.h"

namespace blem_sim::model {
namespace {

RobotModel blocksOf(const std::string& inside) {
  return loadUrdf("<robot name=\"r\"><link name=\"a\"/>" + inside + "</robot>", "test.urdf", UriResolver());
}

std::string textOf(const GazeboBlock& block, const std::string& path) {
  const auto at = std::find_if(block.values.begin(), block.values.end(), [&](const GazeboValue& value) { return value.path == path; });
  return at == block.values.end() ? "(none)" : at->text;
}

TEST(GazeboBlocks, valuesArePathsAndTexts) {
  const RobotModel robot = blocksOf(R"(<gazebo reference="a"><mu1> 0.9
      </mu1><mu2 value="0.8"/><material>Gazebo/Grey</material><selfCollide/></gazebo><gazebo><static>true</static></gazebo>)");
  ASSERT_EQ(robot.gazebo.size(), 2u);
  const GazeboBlock &link = robot.gazebo[0], &whole = robot.gazebo[1];
  EXPECT_EQ(link.element, "gazebo");
  EXPECT_EQ(link.reference, "a");
  EXPECT_EQ(textOf(link, "mu1"), "0.9");
  EXPECT_EQ(textOf(link, "mu2"), "0.8");
  EXPECT_EQ(textOf(link, "selfCollide"), "");
  EXPECT_EQ(link.values.size(), 4u);
  EXPECT_EQ(whole.reference, "");
  EXPECT_EQ(textOf(whole, "static"), "true");
  EXPECT_TRUE(std::none_of(robot.notes.begin(), robot.notes.end(), [](const std::string& n) { return n.find("gazebo") != n.npos; }));
}

TEST(GazeboBlocks, sensorsAndPluginsAreBlocksInside) {
  const RobotModel robot = blocksOf(R"(<gazebo reference="a"><sensor type="ray" name="scan">
      <ray><scan><horizontal><samples>7</samples></horizontal></scan><noise type="gaussian"><stddev>0.1</stddev></noise></ray>
      <plugin name="p" filename="libgazebo_ros_laser.so"><topicName>scan</topicName></plugin></sensor></gazebo>)");
  ASSERT_EQ(robot.gazebo[0].blocks.size(), 1u);
  const GazeboBlock& sensor = robot.gazebo[0].blocks[0];
  EXPECT_EQ(sensor.element, "sensor");
  EXPECT_EQ(sensor.type, "ray");
  EXPECT_EQ(sensor.name, "scan");
  EXPECT_EQ(sensor.reference, "a");
  EXPECT_EQ(textOf(sensor, "ray/scan/horizontal/samples"), "7");
  EXPECT_EQ(textOf(sensor, "ray/noise/type"), "gaussian");
  EXPECT_EQ(textOf(sensor, "ray/noise/stddev"), "0.1");
  EXPECT_EQ(sensor.values.size(), 3u);
  ASSERT_EQ(sensor.blocks.size(), 1u);
  EXPECT_EQ(sensor.blocks[0].type, "libgazebo_ros_laser.so");
  EXPECT_EQ(textOf(sensor.blocks[0], "topicName"), "scan");
}

TEST(GazeboBlocks, absurdSizesAreCut) {
  std::string deep, many = "<gazebo>";
  for (int i = 0; i < 60; ++i) deep += "<d>";
  for (int i = 0; i < 60; ++i) deep += "</d>";
  for (int i = 0; i < 30100; ++i) many += "<x/>";
  const std::string long_name(5000, 'n'), long_text(50000, 't');
  const RobotModel robot = blocksOf("<gazebo reference=\"" + long_name + "\">" + deep + "<text>" + long_text + "</text><" + long_name +
                                    "/></gazebo>" + many + "</gazebo><gazebo/>");
  EXPECT_EQ(robot.gazebo.size(), 2u);
  EXPECT_EQ(robot.gazebo[0].reference.size(), 100u);
  EXPECT_EQ(textOf(robot.gazebo[0], "text").size(), 1000u);
  for (const GazeboValue& value : robot.gazebo[0].values) EXPECT_LE(value.path.size(), 100u);
  const auto told = [](const std::string& note) { return note.find("<gazebo>: 104 elements left out") != note.npos; };
  EXPECT_TRUE(std::any_of(robot.notes.begin(), robot.notes.end(), told)) << robot.notes.at(0);
}

}  // namespace
}  // namespace blem_sim::model
