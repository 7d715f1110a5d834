#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>

#include "blem_sim/sim/config.h"
#include "config/config_sections.h"
#include "config/yaml_text.h"
#include "numbers/nearest_name.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::sim {
namespace {

const double INF = std::numeric_limits<double>::infinity();

SimulationConfig parse(const std::string& yaml) { return parseConfig(YAML::Load(yaml), "world.yaml", "/somewhere"); }

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

TEST(ConfigFile, FilesThatEndInAKeyAreNoYaml) {
  const TemporaryFolder folder;
  for (const char* text : {"objects: [{name:", "{time_step:", "robots: [{gains: {default: {p:"}) {
    const std::string file = folder.write("half.yaml", text);
    EXPECT_TRUE(isOneLineWith(refusal([&] { loadConfigFile(file); }), {file, "is not YAML", "not found"})) << text;
    EXPECT_THROW(loadYaml(text), YAML::Exception) << text;
  }
}

TEST(ConfigFile, ColonsBeforeABracketEnd) {
  EXPECT_EQ(endingYaml("[a, :] # [:]"), "[a, : ] # [:]");
  EXPECT_EQ(endingYaml("{a:]"), "{a: ]");
  EXPECT_EQ(endingYaml("[{a:"), "[{a: ");
  for (const char* kept : {"a:", "a: b[1:]", "[':]']", "[\"x\\\":]\"]", "[1] :]"}) EXPECT_EQ(endingYaml(kept), kept);
  for (const char* text : {"[:]", "{:]", "[a, :]", "{a:]", "# [\n[b:]", "[\"x\\\"\", c:]", "['it''s', d:]"}) {
    try {
      loadYaml(text);
    } catch (const YAML::ParserException& error) {
      EXPECT_NE(error.msg, "") << text;
    }
  }
  EXPECT_EQ(loadYaml("name: a[1:]")["name"].as<std::string>(), "a[1:]");
  EXPECT_EQ(loadYaml("[\"b:]\", 'it''s:]']")[1].as<std::string>(), "it's:]");
  EXPECT_EQ(loadYaml("[\"b:]\"]  # [c:]")[0].as<std::string>(), "b:]");
}

TEST(ConfigFile, ControlCharactersThatEndATextAreNamed) {
  const TemporaryFolder folder;
  const std::string file = folder.write("damaged.yaml", "gravity: [0, 0, 0]\nrobots: [{name:\x04 a}]\n");
  EXPECT_EQ(refusal([&] { loadConfigFile(file); }), file + ":2: is not YAML: the control character 4 is in it; take it out");
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
