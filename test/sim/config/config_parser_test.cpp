#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <set>
#include <sstream>

#include "blem_sim/sim/config.h"
#include "config/config_sections.h"
#include "numbers/nearest_name.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::sim {
namespace {

const double INF = std::numeric_limits<double>::infinity();

SimulationConfig parse(const std::string& yaml) { return parseConfig(YAML::Load(yaml), "world.yaml", "/somewhere"); }

std::string refusalOf(const std::string& yaml) {
  return refusal([&] { parse(yaml); });
}

/** The manual, with or without its commented examples. */
YAML::Node manual(bool with_examples) {
  std::ifstream stream(std::string(BLEM_SIM_SOURCE_DIR) + "/config/default.yaml");
  std::string text;
  for (std::string line; std::getline(stream, line); text += line + "\n")
    if (with_examples && line.compare(0, 3, "#: ") == 0) line = line.substr(3);
  return YAML::Load(text);
}

/** Keys that a document holds, as "robots[].gains.default.p". */
void collectKeys(const YAML::Node& node, const std::string& path, std::set<std::string>* keys) {
  if (node.IsSequence())
    for (const auto& item : node) collectKeys(item, path + "[]", keys);
  if (!node.IsMap()) return;
  for (const auto& entry : node) {
    const std::string key = (path.empty() ? "" : path + ".") + entry.first.Scalar();
    keys->insert(key);
    collectKeys(entry.second, key, keys);
  }
}

/** "a.*.p" stands for any name in the middle. */
bool holdsKey(const std::set<std::string>& keys, const std::string& pattern) {
  const std::size_t star = pattern.find(".*.");
  if (star == std::string::npos) return keys.count(pattern) > 0;
  const std::string head = pattern.substr(0, star + 1), tail = pattern.substr(star + 2);
  for (const std::string& key : keys) {
    if (key.compare(0, head.size(), head) != 0 || key.size() < head.size() + tail.size()) continue;
    if (key.compare(key.size() - tail.size(), tail.size(), tail) != 0) continue;
    const std::string name = key.substr(head.size(), key.size() - head.size() - tail.size());
    if (name.find('.') == std::string::npos) return true;
  }
  return false;
}

TEST(Manual, SaysWhatHoldsWithoutIt) {
  const SimulationConfig manual_config = parseConfig(manual(false), "default.yaml", "");
  const SimulationConfig defaults = parse("");
  EXPECT_EQ(manual_config.time_step, defaults.time_step);
  EXPECT_EQ(manual_config.real_time_factor, defaults.real_time_factor);
  EXPECT_EQ(manual_config.paused, defaults.paused);
  EXPECT_EQ(manual_config.gravity, defaults.gravity);
  EXPECT_EQ(manual_config.random_seed, defaults.random_seed);
  EXPECT_EQ(manual_config.solver.stepper, defaults.solver.stepper);
  EXPECT_EQ(manual_config.solver.threads, defaults.solver.threads);
  EXPECT_EQ(manual_config.solver.quick_step_iterations, defaults.solver.quick_step_iterations);
  EXPECT_EQ(manual_config.solver.cfm, defaults.solver.cfm);
  EXPECT_EQ(manual_config.solver.correction_fraction, defaults.solver.correction_fraction);
  EXPECT_EQ(manual_config.solver.max_correction_speed, defaults.solver.max_correction_speed);
  EXPECT_EQ(manual_config.solver.joint_erp, defaults.solver.joint_erp);
  EXPECT_EQ(manual_config.solver.joint_cfm, defaults.solver.joint_cfm);
  EXPECT_EQ(manual_config.contact.boundary_width.metres, defaults.contact.boundary_width.metres);
  EXPECT_EQ(manual_config.contact.surface.friction, defaults.contact.surface.friction);
  EXPECT_EQ(manual_config.contact.surface.restitution, defaults.contact.surface.restitution);
  EXPECT_EQ(manual_config.contact.surface.impact_friction_factor, defaults.contact.surface.impact_friction_factor);
  EXPECT_EQ(manual_config.contact.surface.impact_friction_speed, defaults.contact.surface.impact_friction_speed);
  EXPECT_EQ(manual_config.contact.surface.stiffness, INF);
  EXPECT_EQ(manual_config.contact.surface.damping, INF);
  EXPECT_EQ(manual_config.contact.friction_rule, defaults.contact.friction_rule);
  EXPECT_EQ(manual_config.contact.max_contacts_per_robot, defaults.contact.max_contacts_per_robot);
  EXPECT_EQ(manual_config.contact.max_contacts_per_object, defaults.contact.max_contacts_per_object);
  EXPECT_EQ(manual_config.contact.reduction, defaults.contact.reduction);
  EXPECT_EQ(manual_config.contact.mending, defaults.contact.mending);
  EXPECT_EQ(manual_config.contact.shrink, defaults.contact.shrink);
  EXPECT_EQ(manual_config.rates.clock, defaults.rates.clock);
  EXPECT_EQ(manual_config.rates.joint_state, defaults.rates.joint_state);
  EXPECT_EQ(manual_config.rates.tf, defaults.rates.tf);
  EXPECT_EQ(manual_config.rates.odom, defaults.rates.odom);
  EXPECT_EQ(manual_config.rates.contact, defaults.rates.contact);
  EXPECT_EQ(manual_config.rates.markers, defaults.rates.markers);
  EXPECT_EQ(manual_config.rates.link_states, defaults.rates.link_states);
  EXPECT_EQ(manual_config.rates.step_report, defaults.rates.step_report);
  EXPECT_TRUE(manual_config.robots.empty() && manual_config.environments.empty() && manual_config.objects.empty());
}

TEST(Manual, HoldsEveryKnownKey) {
  const YAML::Node document = manual(true);
  std::set<std::string> known, written;
  const SimulationConfig config = parseConfig(document, "default.yaml", "", &known);
  EXPECT_EQ(config.robots.size(), 2u);
  EXPECT_EQ(config.robots[0].sensors.size(), 10u);
  ASSERT_TRUE(config.robots[0].controllers);
  EXPECT_EQ(config.robots[0].controllers->size(), 4u);
  EXPECT_FALSE(config.robots[1].controllers);
  EXPECT_EQ(config.objects.size(), 2u);
  ASSERT_EQ(config.environments.size(), 6u);
  EXPECT_EQ(config.environments[4].live.type, LiveConfig::Type::GRID);
  EXPECT_EQ(config.environments[4].live.wall_height, 1);
  collectKeys(document, "", &written);
  EXPECT_GT(known.size(), 90u);
  for (const std::string& key : known) EXPECT_TRUE(holdsKey(written, key)) << key << " is not in config/default.yaml";
}

TEST(ConfigParser, ReadsTheRobotOfTheContract) {
  const SimulationConfig config = parse(R"(
robots:
  - name: hubo
    urdf: "package://huboplus/huboplus.urdf"
    namespace: left
    pose: {xyz: [1, 2, 0.8], rpy: [0, 0, 1.5707963267948966]}
    initial_positions: {LKP: 0.4}
    disable_collisions: [[LinkA, LinkB]]
    friction: 1.0
    links: {Body_LAR: {friction: 0.9, shrink: true, boundary_width: 0.01, stiffness: 80000, damping: 20000}}
    gains: {LKP: {p: 3000, d: 10, i_clamp: 50}, default: {p: 100, i: 2, d: 1}}
    motor: {default: implicit_pd, LKP: pid}
    joint_friction: {default: {dry: 0, viscous: 0.5}, LKP: {dry: 0.1}}
    effort_limits: {LKP: 150, LAR: .inf}
    armature: {LKP: 0.03}
    motors: free
    velocity_limits: {LKP: 2, LAR: .inf}
    command_timeout: 0.5
    max_contacts_per_robot: 12
)");
  const RobotConfig& robot = config.robots.at(0);
  EXPECT_EQ(config.base_directory, "/somewhere");
  EXPECT_EQ(robot.name_space, "left");
  EXPECT_FALSE(robot.fixed_base);
  EXPECT_LT((robot.X_WR * Vector3::UnitX() - Vector3(1, 3, 0.8)).norm(), 1e-15);
  EXPECT_EQ(robot.initial_positions.at("LKP"), 0.4);
  EXPECT_EQ(robot.disable_collisions.at(0), std::make_pair(std::string("LinkA"), std::string("LinkB")));
  EXPECT_EQ(robot.contact.friction, 1.0);
  EXPECT_FALSE(robot.contact.boundary_width.has_value());
  EXPECT_EQ(robot.links.at("Body_LAR").shrink, true);
  EXPECT_EQ(robot.links.at("Body_LAR").stiffness, 80000);
  EXPECT_FALSE(robot.links.at("Body_LAR").restitution.has_value());
  EXPECT_EQ(robot.gains.at("LKP").p, 3000);
  EXPECT_EQ(robot.gains.at("LKP").i, 2) << "what a joint leaves out comes from default, wherever that stands in the map";
  EXPECT_EQ(robot.gains.at("LKP").i_clamp, 50);
  EXPECT_EQ(robot.gains.at("default").i_clamp, INF);
  EXPECT_EQ(robot.motor.at("default"), MotorLaw::IMPLICIT_PD);
  EXPECT_EQ(robot.motor.at("LKP"), MotorLaw::PID);
  EXPECT_EQ(robot.motors, MotorDefault::FREE);
  EXPECT_EQ(robot.velocity_limits.at("LKP"), 2);
  EXPECT_EQ(robot.command_timeout, 0.5);
  EXPECT_EQ(robot.joint_friction.at("LKP").dry, 0.1);
  EXPECT_EQ(robot.joint_friction.at("LKP").viscous, 0.5);
  EXPECT_EQ(robot.effort_limits.at("LAR"), INF);
  EXPECT_EQ(robot.armature.at("LKP"), 0.03);
  EXPECT_EQ(robot.max_contacts, 12);
}

TEST(ConfigParser, MotorMayBeOneWord) {
  const auto config = parse("robots: [{name: a, urdf: a.urdf, motor: implicit_pd}]");
  EXPECT_EQ(config.robots[0].motor.at("default"), MotorLaw::IMPLICIT_PD);
  EXPECT_TRUE(parse("robots: [{name: a, urdf: a.urdf}]").robots[0].motor.empty());
  EXPECT_EQ(parse("robots: [{name: a, urdf: a.urdf}]").robots[0].motors, MotorDefault::COMPUTED);
}

TEST(ConfigParser, ReadsPidGainsAsGazeboRosControlHasThem) {
  const auto gains = parsePidGains(
      YAML::Load("{LKP: {p: 100, i: 1, d: 5, i_clamp_min: -3, i_clamp_max: 3, antiwindup: true}, LAR: {p: 20, i_clamp: 2}}"), "/pid_gains");
  EXPECT_EQ(gains.at("LKP").p, 100);
  EXPECT_EQ(gains.at("LKP").i_clamp, 3);
  EXPECT_EQ(gains.at("LAR").i_clamp, 2);
  EXPECT_EQ(gains.at("LAR").d, 0);
  for (const char* bad : {"{LKP: 3}", "[1]", "{LKP: {p: -1}}", "{LKP: {d: fast}}"})
    EXPECT_THROW(parsePidGains(YAML::Load(bad), "/pid_gains"), InputError) << bad;
}

TEST(ConfigParser, ReadsSensors) {
  const auto sensors = parse(R"(
robots:
  - name: hubo
    urdf: hubo.urdf
    sensors:
      - {name: ankle, type: force_torque, joint: LAR, frame: sensor, measure: child_to_parent, noise: {stddev: 0.5}}
      - {name: imu, type: imu, link: torso, pose: {xyz: [0, 0, 0.1]}, rate: 200, noise: {accel_stddev: 0.1, gyro_bias_stddev: 0.2}}
      - {name: sole, type: contact, link: foot, topic: soles/left}
      - {name: tilt, type: tilt, link: torso}
      - {name: motors, type: motor_current, torque_constant: {default: 1.5, LAR: 2}}
)")
                           .robots[0]
                           .sensors;
  ASSERT_EQ(sensors.size(), 5u);
  EXPECT_EQ(sensors[0].type, SensorType::FORCE_TORQUE);
  EXPECT_EQ(sensors[0].frame, "sensor");
  EXPECT_EQ(sensors[0].measure, "child_to_parent");
  for (const QuantityNoise& noise : sensors[0].noise) EXPECT_EQ(noise.stddev, 0.5);
  EXPECT_EQ(sensors[1].X_LS.translation().z(), 0.1);
  EXPECT_EQ(sensors[1].noise[0].stddev, 0.1);
  EXPECT_EQ(sensors[1].noise[1].bias_stddev, 0.2);
  EXPECT_EQ(sensors[1].rate, 200);
  EXPECT_EQ(sensors[2].topic, "soles/left");
  EXPECT_EQ(sensors[3].type, SensorType::TILT);
  EXPECT_EQ(sensors[4].torque_constant.at("LAR"), 2);
}

TEST(ConfigParser, ReadsEnvironmentsAndObjects) {
  const auto config = parse(R"(
contact: {friction_rule: harmonic_mean, reduction: kmeans}
solver: {stepper: quick_step, threads: 3, quick_step_iterations: 99}
random_seed: 18446744073709551615
environments:
  - {name: ladder, uri: ladder.ply, scale: 0.25, cloud: {as: mesh, max_edge: 0.02}}
  - {name: live, topic: /points, frame: map, update: accumulate, fade_speed: 0.001, map: {voxel: 0.01, min_hits: 3, memory: 50, expire_after: 2, max_voxels: 10},
     cloud: {as: points, point_radius: auto, filters: [{voxel_grid: 0.005}, {statistical_outliers: {neighbours: 16, factor: 2}}, {radius_outliers: {radius: 0.1, neighbours: 3}}, {pass_through: {axis: x, range: [-.inf, 2]}}]}}
  - {name: ground, plane: [0, 0, 2, 1], boundary_width: 0.001}
objects:
  - {name: mug, uri: mug.stl, mass: 1, com: [1, 2, 3], inertia: [3, 0.1, 0.2, 4, 0.3, 5], mesh_pose: {xyz: [0, 0, 1]}, linear_velocity: [1, 0, 0]}
  - {name: crate, urdf: crate.urdf, max_contacts_per_object: 7}
)");
  EXPECT_EQ(config.contact.friction_rule, contact::FrictionRule::HARMONIC_MEAN);
  EXPECT_EQ(config.contact.reduction, "kmeans");
  EXPECT_EQ(config.solver.stepper, "quick_step");
  EXPECT_EQ(config.solver.threads, 3);
  EXPECT_EQ(config.solver.quick_step_iterations, 99);
  EXPECT_EQ(config.random_seed, 18446744073709551615u);
  EXPECT_EQ(config.environments[0].scale, Vector3::Constant(0.25));
  EXPECT_EQ(config.environments[0].cloud.as, model::CloudOptions::As::MESH);
  const LiveConfig& live = config.environments[1].live;
  EXPECT_EQ(live.topic, "/points");
  EXPECT_EQ(live.frame, "map");
  EXPECT_EQ(live.update, LiveConfig::Update::ACCUMULATE);
  EXPECT_EQ(live.fade_speed, 0.001);
  EXPECT_EQ(live.map.voxel, 0.01);
  EXPECT_EQ(live.map.min_hits, 3);
  EXPECT_EQ(live.map.memory, 50);
  EXPECT_EQ(live.map.expire_after, 2);
  EXPECT_EQ(live.map.max_voxels, 10u);
  const model::CloudOptions& cloud = config.environments[1].cloud;
  EXPECT_TRUE(cloud.auto_radius);
  ASSERT_EQ(cloud.filters.size(), 4u);
  EXPECT_EQ(cloud.filters[0].size, 0.005);
  EXPECT_EQ(cloud.filters[1].neighbours, 16);
  EXPECT_EQ(cloud.filters[1].factor, 2);
  EXPECT_EQ(cloud.filters[2].size, 0.1);
  EXPECT_EQ(cloud.filters[3].axis, 0);
  EXPECT_EQ(cloud.filters[3].lower, -INF);
  EXPECT_EQ(cloud.filters[3].upper, 2);
  EXPECT_EQ(*config.environments[2].plane, Eigen::Vector4d(0, 0, 2, 1));
  Matrix3 inertia;
  inertia << 3, 0.1, 0.2, 0.1, 4, 0.3, 0.2, 0.3, 5;
  EXPECT_EQ(*config.objects[0].inertia, inertia);
  EXPECT_EQ(*config.objects[0].com, Vector3(1, 2, 3));
  EXPECT_EQ(config.objects[0].X_OM.translation().z(), 1);
  EXPECT_EQ(config.objects[0].linear_velocity.x(), 1);
  EXPECT_EQ(config.objects[1].max_contacts, 7);
  EXPECT_FALSE(config.objects[1].mass.has_value());
}

TEST(ConfigParser, TakesWhatXmlRpcMakesOfNumbers) {
  YAML::Node root(YAML::NodeType::Map);
  root["time_step"] = std::string("1e-3");  // rosparam reads 1e-3 as a text
  root["gravity"].push_back(0);
  root["gravity"].push_back(0);
  root["gravity"].push_back(-9);
  root["real_time_factor"] = 2;
  root["paused"] = true;
  root["layer_markers"] = true;
  root["contact"]["stiffness"] = std::string(".inf");
  root["contact"]["max_contacts_per_robot"] = 30.0;
  const SimulationConfig config = parseConfig(root, "/blem_sim", "");
  EXPECT_EQ(config.time_step, 1e-3);
  EXPECT_EQ(config.gravity, Vector3(0, 0, -9));
  EXPECT_EQ(config.real_time_factor, 2);
  EXPECT_TRUE(config.paused);
  EXPECT_TRUE(config.layer_markers);
  EXPECT_EQ(config.contact.surface.stiffness, INF);
  EXPECT_EQ(config.contact.max_contacts_per_robot, 30);
  root["contact"]["frction"] = 1;
  EXPECT_EQ(refusal([&] { parseConfig(root, "/blem_sim", ""); }),
            "/blem_sim: contact.frction: unknown key; the nearest known one is 'friction'");
}

struct BadInput {
  const char* yaml;
  std::vector<std::string> words;  ///< that the refusal must hold
};

class ConfigRefusal : public testing::TestWithParam<BadInput> {};

TEST_P(ConfigRefusal, IsOneLineThatNamesFileKeyAndCure) {
  const std::string text = refusalOf(GetParam().yaml);
  EXPECT_EQ(text.rfind("world.yaml", 0), 0u) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  for (const std::string& word : GetParam().words) EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' in: " << text;
}

INSTANTIATE_TEST_SUITE_P(
    Inputs, ConfigRefusal,
    testing::Values(
        BadInput{"gravity: [0, 0, -9.81]\ntimestep: 0.001", {"world.yaml:2: timestep", "'time_step'"}},
        BadInput{"robots:\n- name: a\n  urdf: a\n  gians: {}", {"world.yaml:4: robots[0].gians", "'gains'"}},
        BadInput{"robots: [{name: a, urdf: a, gains: {LKP: {P: 1}}}]", {"robots[0].gains.LKP.P", "'p'"}},
        BadInput{"robots: [{name: a, urdf: a, links: {foot: {frction: 1}}}]", {"robots[0].links.foot.frction", "'friction'"}},
        BadInput{"robots: [{name: a, urdf: a, sensors: [{name: s, type: imu, link: b, joint: c}]}]",
                 {"robots[0].sensors[0].joint", "unknown"}},
        BadInput{"robots: [{name: a, urdf: a, sensors: [{name: s, type: imu, link: b, noise: {stddev: 1}}]}]",
                 {"noise.stddev", "gyro_stddev"}},
        BadInput{"robots: [{name: a, urdf: a, sensors: [{name: s, type: imu}]}]", {"sensors[0]", "link", "missing"}},
        BadInput{"robots: [{name: a, urdf: a, sensors: [{name: s, type: laser}]}]", {"sensors[0].type", "motor_current", "'laser'"}},
        BadInput{"robots: [{name: a, urdf: a, sensors: [{name: s}]}]", {"sensors[0].type", "missing"}},
        BadInput{"robots: [{name: a, urdf: a, sensors: [{name: s, type: tilt, link: b}, {name: s, type: tilt, link: b}]}]",
                 {"sensors[1].name", "taken"}},
        BadInput{"robots: [{name: a}]", {"robots[0]", "urdf", "description_param"}},
        BadInput{"robots: [{name: a, urdf: a, description_param: b}]", {"robots[0]", "exactly one"}},
        BadInput{"robots: [{urdf: a}]", {"robots[0].name", "missing"}},
        BadInput{"robots: [{name: 'a::b', urdf: a}]", {"robots[0].name", "::"}},
        BadInput{"robots: {name: a}", {"robots", "must be a list"}}, BadInput{"robots: [a]", {"robots[0]", "must be a map"}},
        BadInput{"robots: [{name: a, urdf: a, motor: servo}]", {"robots[0].motor", "pid, implicit_pd", "'servo'"}},
        BadInput{"robots: [{name: a, urdf: a, motor: {LKP: servo}}]", {"robots[0].motor.LKP", "'servo'"}},
        BadInput{"robots: [{name: a, urdf: a, gains: 3}]", {"robots[0].gains", "must be a map"}},
        BadInput{"robots: [{name: a, urdf: a, gains: {LKP: {p: -1}}}]", {"gains.LKP.p", "at least 0", "'-1'"}},
        BadInput{"robots: [{name: a, urdf: a, initial_positions: {LKP: .nan}}]", {"initial_positions.LKP", "finite"}},
        BadInput{"robots: [{name: a, urdf: a, disable_collisions: [[a]]}]", {"disable_collisions", "pairs"}},
        BadInput{"robots: [{name: a, urdf: a}]\nobjects: [{name: a, uri: m, mass: 1}]", {"objects[0].name", "'a' is taken"}},
        BadInput{"environments: [{name: e}]", {"environments[0]", "uri, plane or topic"}},
        BadInput{"environments: [{name: e, uri: a, topic: b}]", {"environments[0]", "exactly one"}},
        BadInput{"environments: [{name: e, plane: [0, 0, 0, 1]}]", {"environments[0].plane", "normal"}},
        BadInput{"environments: [{name: e, plane: [0, 0, 1]}]", {"environments[0].plane", "list of 4"}},
        BadInput{"environments: [{name: e, uri: a, scale: [1, 0, 1]}]", {"environments[0].scale", "0"}},
        BadInput{"environments: [{name: e, uri: a, frame: world}]", {"environments[0].frame", "topic"}},
        BadInput{"environments: [{name: e, uri: a, update: replace}]", {"environments[0].update", "topic"}},
        BadInput{"environments: [{name: e, topic: a, pose: {}}]", {"environments[0].pose", "tf"}},
        BadInput{"environments: [{name: e, topic: a, update: mix}]", {"environments[0].update", "replace, accumulate", "'mix'"}},
        BadInput{"environments: [{name: e, topic: a, map: {voxel: 1}}]", {"environments[0].map", "accumulate"}},
        BadInput{"environments: [{name: e, topic: a, update: accumulate, map: {voxel: 0}}]", {"map.voxel", "above 0"}},
        BadInput{"environments: [{name: e, topic: a, fade_speed: 0}]", {"fade_speed", "above 0"}},
        BadInput{"environments: [{name: e, uri: a, type: mesh}]", {"environments[0].type", "topic"}},
        BadInput{"environments: [{name: e, topic: a, type: map}]", {"environments[0].type", "cloud, mesh, grid", "'map'"}},
        BadInput{"environments: [{name: e, topic: a, type: mesh, cloud: {as: mesh}}]", {"environments[0].cloud", "type: cloud"}},
        BadInput{"environments: [{name: e, topic: a, type: grid, update: accumulate}]", {"environments[0].update", "type: cloud"}},
        BadInput{"environments: [{name: e, topic: a, type: mesh, occupied: 3}]", {"environments[0].occupied", "type: grid"}},
        BadInput{"environments: [{name: e, topic: a, type: grid, occupied: 101}]", {"environments[0].occupied", "1 to 100"}},
        BadInput{"environments: [{name: e, topic: a, type: grid, wall_height: 0}]", {"environments[0].wall_height", "above 0"}},
        BadInput{"environments: [{name: e, topic: a, update: accumulate, cloud: {as: mesh, mesher: organized}}]", {"cloud.mesher", "grid"}},
        BadInput{"environments: [{name: e, topic: a, cloud: {as: mesh, mesher: organized, filters: [{voxel_grid: 1}]}}]",
                 {"cloud.mesher", "grid"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {point_radius: big}}]", {"cloud.point_radius", "'big'"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {filters: [{voxels: 1}]}}]", {"filters[0].voxels", "'voxel_grid'"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {filters: [{}]}}]", {"filters[0]", "exactly one"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {filters: [{voxel_grid: -1}]}}]", {"voxel_grid", "above 0"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {filters: [{statistical_outliers: {neighbours: 0}}]}}]", {"neighbours"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {filters: [{radius_outliers: {radius: 0}}]}}]", {"radius", "above 0"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {filters: [{pass_through: {range: [0, 1]}}]}}]", {"axis", "missing"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {filters: [{pass_through: {axis: x, range: [1, 0]}}]}}]",
                 {"range", "lower first"}},
        BadInput{"environments: [{name: e, uri: a, pose: [0, 0, 0]}]", {"environments[0].pose", "must be a map"}},
        BadInput{"environments: [{name: e, uri: a, pose: {xyz: [0, 0, x]}}]", {"environments[0].pose.xyz", "finite", "'x'"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {as: voxels}}]", {"environments[0].cloud.as", "auto, points, mesh"}},
        BadInput{"environments: [{name: e, uri: a, cloud: {point_radius: 0}}]", {"cloud.point_radius", "above 0"}},
        BadInput{"objects: [{name: o, uri: a}]", {"objects[0].mass", "missing"}},
        BadInput{"objects: [{name: o, uri: a, mass: 0}]", {"objects[0].mass", "above 0"}},
        BadInput{"objects: [{name: o, uri: a, mass: -1}]", {"objects[0].mass", "above 0"}},
        BadInput{"objects: [{name: o, uri: a, mass: 1, inertia: [1, 2, 0, 1, 0, 1]}]", {"objects[0].inertia", "positive definite"}},
        BadInput{"objects: [{name: o, mass: 1}]", {"objects[0]", "uri or urdf"}}, BadInput{"time_step: 0", {"time_step", "above 0"}},
        BadInput{"time_step: .nan", {"time_step"}}, BadInput{"time_step: fast", {"time_step", "'fast'"}},
        BadInput{"time_step: [1]", {"time_step", "a list"}}, BadInput{"time_step: .inf", {"time_step", "finite"}},
        BadInput{"paused: maybe", {"paused", "true or false"}}, BadInput{"layer_markers: some", {"layer_markers", "true or false"}},
        BadInput{"random_seed: -1", {"random_seed", "'-1'"}}, BadInput{"random_seed: 1.5", {"random_seed"}},
        BadInput{"contact: {friction: .inf}", {"contact.friction", "finite"}},
        BadInput{"contact: {restitution: 1.1}", {"contact.restitution"}},
        BadInput{"contact: {impact_friction_factor: 1.1}", {"contact.impact_friction_factor"}},
        BadInput{"contact: {impact_friction_speed: -1}", {"contact.impact_friction_speed"}},
        BadInput{"contact: {stiffness: 0}", {"contact.stiffness", ".inf"}},
        BadInput{"contact: {max_contacts_per_robot: 0}", {"contact.max_contacts_per_robot"}},
        BadInput{"contact: {max_contacts_per_robot: 2.5}", {"contact.max_contacts_per_robot", "whole"}},
        BadInput{"contact: {reduction: best}", {"contact.reduction", "hull, hierarchical, kmeans, none"}},
        BadInput{"contact: {friction_rule: max}", {"contact.friction_rule", "harmonic_mean"}},
        BadInput{"solver: {stepper: bullet}", {"solver.stepper", "world_step"}},
        BadInput{"solver: {iterations: 3}", {"solver.iterations", "unknown key"}}, BadInput{"gravity: [0, 0]", {"gravity", "list of 3"}},
        BadInput{"gravity: -9.81", {"gravity", "list of 3"}}, BadInput{"time_step: 0.1\ntime_step: 0.2", {"time_step", "twice"}},
        BadInput{"just words", {"must be a map"}}, BadInput{"joint_state_rate: -3", {"joint_state_rate", "at least 0"}}));

TEST(ConfigParser, AnEnvironmentAlone) {
  const auto environment = parseEnvironment(YAML::Load("{name: e, uri: a.ply, friction: 0.3}"), "~load_environment");
  EXPECT_EQ(environment.contact.friction, 0.3);
  const std::string text = refusal([&] { parseEnvironment(YAML::Load("{name: e, uri: a.ply, frition: 0.3}"), "~load_environment"); });
  EXPECT_TRUE(isOneLineWith(text, {"~load_environment", "frition", "'friction'"})) << text;
}

TEST(ConfigParser, AFileIsReadAgainstItsFolder) {
  TemporaryFolder folder;
  const std::string file = folder.write("worlds/a.yaml", "time_step: 0.002\n");
  EXPECT_EQ(loadConfigFile(file).base_directory, folder.path("worlds"));
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadConfigFile(folder.path("none.yaml")); }), {"none.yaml", "cannot be read"}));
  const std::string broken = folder.write("broken.yaml", "a: 1\nb: [1, 2\nc: }\n");
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadConfigFile(broken); }), {"broken.yaml:", "is not YAML"}));
  const std::string empty = folder.write("empty.yaml", "");
  EXPECT_EQ(loadConfigFile(empty).time_step, 0.001);
}

TEST(NearestName, TakesTheFewestEdits) {
  EXPECT_EQ(nearestName("gians", {"gain", "gains", "links"}), "gains");
  EXPECT_EQ(nearestName("b", {"a", "c"}), "a") << "the first on a tie";
  EXPECT_EQ(nearestName("x", {}), "");
}

// The list is refused before a node is built, of which each takes kilobytes.
TEST(ConfigFile, AMillionObjectsAreRefusedWhereTheyBecomeTooMany) {
  const TemporaryFolder folder;
  std::string text = "time_step: 0.001\nobjects:\n";
  for (int i = 0; i < 1000000; ++i) text += "- {name: c, uri: a.off}\n";
  const std::string file = folder.write("many.yaml", text);
  EXPECT_EQ(refusal([&] { loadConfigFile(file); }),
            file + ":100003: objects: has more than the 100000 entries that are simulated; give fewer");
}

TEST(ConfigFile, LongListsAreNamedWhereTheyAre) {
  const TemporaryFolder folder;
  std::string text = "robots: [{name: a}, {name: b, gains: [";
  for (int i = 0; i < 100001; ++i) text += "1, ";
  const std::string file = folder.write("deep.yaml", text + "1]}]\n");
  EXPECT_EQ(refusal([&] { loadConfigFile(file); }),
            file + ":1: robots[1].gains: has more than the 100000 entries that are simulated; give fewer");
  std::string most = "objects: [";
  for (int i = 0; i < 99999; ++i) most += "1, ";
  const std::string taken = folder.write("most.yaml", most + "1]\n");
  EXPECT_EQ(loadYamlFile(taken)["objects"].size(), 100000u);
}

}  // namespace
}  // namespace blem_sim::sim
