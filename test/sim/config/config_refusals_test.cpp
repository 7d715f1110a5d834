// Faulty configurations: one line that names the file, the key and the cure.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "blem_sim/sim/config.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

struct BadInput {
  const char* yaml;
  std::vector<std::string> words;  ///< that the refusal must hold
};

class ConfigRefusal : public testing::TestWithParam<BadInput> {};

TEST_P(ConfigRefusal, IsOneLineThatNamesFileKeyAndCure) {
  const std::string text = refusal([&] { parseConfig(YAML::Load(GetParam().yaml), "world.yaml", "/somewhere"); });
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
        BadInput{"solver: {threads: all}", {"solver.threads", "a whole number of at least 1, or auto", "'all'"}},
        BadInput{"solver: {threads: 0}", {"solver.threads", "a whole number of at least 1, or auto"}},
        BadInput{"solver: {iterations: 3}", {"solver.iterations", "unknown key"}}, BadInput{"gravity: [0, 0]", {"gravity", "list of 3"}},
        BadInput{"gravity: -9.81", {"gravity", "list of 3"}}, BadInput{"time_step: 0.1\ntime_step: 0.2", {"time_step", "twice"}},
        BadInput{"just words", {"must be a map"}}, BadInput{"joint_state_rate: -3", {"joint_state_rate", "at least 0"}}));

}  // namespace
}  // namespace blem_sim::sim
