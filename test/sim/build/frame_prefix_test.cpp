// Frames of robots of one URDF.
#include <algorithm>

#include "sim/simulation_scene.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

RobotConfig withPrefix(const std::string& name, const std::string& prefix) {
  RobotConfig config = robot(name, pendulumUrdf(), true);
  config.tf_prefix = prefix;
  return config;
}

std::vector<std::string> prefixesOf(const std::vector<RobotConfig>& robots, std::vector<std::string>* notes = nullptr) {
  SimulationConfig config;
  config.robots = robots;
  const Simulator simulator(config, model::UriResolver());
  std::vector<std::string> prefixes;
  for (const RobotInfo& robot : simulator.robots()) prefixes.push_back(robot.tf_prefix);
  if (notes) *notes = simulator.notes();
  return prefixes;
}

TEST(FramePrefix, KeepsRobotsOfOneUrdfApart) {
  std::vector<std::string> notes;
  EXPECT_EQ(prefixesOf({withPrefix("a", ""), withPrefix("b", "/"), withPrefix("c", "/left/"), withPrefix("d", "left")}, &notes),
            (std::vector<std::string>{"", "b", "left", "d"}));
  const auto told =
      std::count_if(notes.begin(), notes.end(), [](const std::string& note) { return note.find("set tf_prefix") != std::string::npos; });
  EXPECT_EQ(told, 2);
}

TEST(FramePrefix, IsLeftAloneWhereNoFramesClash) {
  RobotConfig other = robot("other", R"(<robot name="other"><link name="world"/><link name="x"/>
    <joint name="j" type="fixed"><parent link="world"/><child link="x"/></joint></robot>)",
                            true);
  RobotConfig third = robot("third", R"(<robot name="third"><link name="world"/><link name="y"/>
    <joint name="j" type="fixed"><parent link="world"/><child link="y"/></joint></robot>)",
                            true);
  EXPECT_EQ(prefixesOf({withPrefix("a", ""), withPrefix("b", "b"), other, third}), (std::vector<std::string>{"", "b", "", ""}));
}

TEST(FramePrefix, ThatClashesAllTheSameIsRefused) {
  const std::string told = refusal([] { prefixesOf({withPrefix("a", ""), withPrefix("b", "c"), withPrefix("c", "")}); });
  EXPECT_TRUE(isOneLineWith(told, {"robots: c: tf_prefix", "'a'", "'b'", "'base'"})) << told;
}

TEST(FramePrefix, OfASpawnedRobotStaysWhenTheOtherOneGoes) {
  SimulationConfig config;
  config.robots = {withPrefix("a", "")};
  Simulator simulator(config, model::UriResolver());
  simulator.spawn(withPrefix("b", ""));
  simulator.removeModel("a");
  ASSERT_EQ(simulator.robots().size(), 1u);
  EXPECT_EQ(simulator.robots()[0].tf_prefix, "b");
  EXPECT_EQ(std::count_if(simulator.notes().begin(), simulator.notes().end(),
                          [](const std::string& note) { return note.find("'b/'") != std::string::npos; }),
            1);
}

}  // namespace
}  // namespace blem_sim::sim
