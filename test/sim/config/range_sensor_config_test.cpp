// Settings of depth cameras and lidars: read, and refused in one line that names the key.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "sim/simulation_scene.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

SimulationConfig parseSensors(const std::string& sensors) {
  return parseConfig(YAML::Load("robots: [{name: a, urdf: a.urdf, sensors: [" + sensors + "]}]"), "scene.yaml", "");
}

TEST(RangeSensorConfig, IsRead) {
  const auto sensors = parseSensors(R"(
    {name: eye, type: depth_camera, link: head, width: 320, height: 200, hfov: 1.2, range: [0.3, 8], noise: {model: kinect}},
    {name: scan, type: lidar, link: base, beams: 90, layers: 16, angle: [-1, 1], vertical_angle: [-0.2, 0.3], rate: 10, noise: {stddev: 0.02}},
    {name: plain, type: lidar, link: base})")
                           .robots[0]
                           .sensors;
  ASSERT_EQ(sensors.size(), 3u);
  const RangeSensorConfig &eye = sensors[0].rays, &scan = sensors[1].rays, &plain = sensors[2].rays;
  EXPECT_EQ(sensors[0].rate, 30);
  EXPECT_EQ((std::vector<double>{eye.nearest, eye.farthest, eye.hfov}), (std::vector<double>{0.3, 8, 1.2}));
  EXPECT_EQ(eye.width * 1000 + eye.height, 320200);
  EXPECT_EQ(eye.noise, RangeNoise::KINECT);
  EXPECT_EQ(sensors[1].rate, 10);
  EXPECT_EQ(scan.stddev, 0.02);
  EXPECT_EQ((std::vector<double>{scan.first_angle, scan.last_angle, scan.lowest_angle, scan.highest_angle}),
            (std::vector<double>{-1, 1, -0.2, 0.3}));
  EXPECT_EQ(scan.layers * 1000 + scan.beams, 16090);
  EXPECT_EQ(sensors[2].rate, 40);
  EXPECT_EQ((std::vector<double>{plain.nearest, plain.farthest}), (std::vector<double>{0.1, 30}));
}

TEST(RangeSensorConfig, IsRefusedInOneLine) {
  struct Bad {
    const char *type, *settings, *key;
  };
  const Bad bad[] = {{"depth_camera", "width: 0", "width: is 0; give it a whole number of at least 1"},
                     {"depth_camera", "height: -3", "height"},
                     {"depth_camera", "width: 100000, height: 100000", "width"},
                     {"depth_camera", "hfov: 4", "hfov"},
                     {"depth_camera", "hfov: 0", "hfov"},
                     {"depth_camera", "range: [5, 0.4]", "range"},
                     {"depth_camera", "range: [-1, 5]", "range"},
                     {"depth_camera", "range: 5", "range"},
                     {"depth_camera", "noise: {model: foggy}", "noise.model"},
                     {"depth_camera", "noise: {stddev: -1}", "noise.stddev"},
                     {"depth_camera", "beams: 3", "beams"},
                     {"lidar", "beams: 0", "beams"},
                     {"lidar", "layers: 0", "layers"},
                     {"lidar", "angle: [1, -1]", "angle"},
                     {"lidar", "angle: [-4, 4]", "angle"},
                     {"lidar", "layers: 4", "vertical_angle"},
                     {"lidar", "vertical_angle: [-0.1, 0.1]", "vertical_angle"},
                     {"lidar", "layers: 4, vertical_angle: [-2, 2]", "vertical_angle"},
                     {"lidar", "noise: {model: kinect}", "noise.model"}};
  for (const Bad& each : bad) {
    const std::string text =
        refusal([&] { parseSensors("{name: s, type: " + std::string(each.type) + ", link: b, " + std::string(each.settings) + "}"); });
    EXPECT_TRUE(isOneLineWith(text, {"scene.yaml", "sensors[0]", each.key})) << each.settings << ": '" << text << "'";
  }
}

TEST(RangeSensorConfig, ByHandIsRefusedAsWell) {
  using Set = void (*)(SensorConfig*);
  const std::vector<std::pair<const char*, Set>> bad = {
      {"eye: link", [](SensorConfig* s) { s->link = "bse"; }},       {"eye: hfov", [](SensorConfig* s) { s->rays.hfov = NAN; }},
      {"eye: width", [](SensorConfig* s) { s->rays.width = 0; }},    {"eye: range", [](SensorConfig* s) { s->rays.farthest = INFINITY; }},
      {"eye: noise", [](SensorConfig* s) { s->rays.stddev = NAN; }},
  };
  for (const auto& [words, set] : bad) {
    SimulationConfig config;
    config.robots = {robot("arm", pendulumUrdf(), true)};
    SensorConfig eye;
    eye.name = "eye";
    eye.type = SensorType::DEPTH_CAMERA;
    eye.link = "base";
    config.robots[0].sensors = {eye};
    EXPECT_EQ(refusal([&] { Simulator simulator(config, model::UriResolver()); }), "");
    set(&config.robots[0].sensors[0]);
    const std::string text = refusal([&] { Simulator simulator(config, model::UriResolver()); });
    EXPECT_TRUE(isOneLineWith(text, {words})) << text;
  }
}

}  // namespace
}  // namespace blem_sim::sim
