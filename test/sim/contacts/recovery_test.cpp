// Past the layer: a body that starts inside another, or was driven into it, leaves it steadily and the way it came, and comes to rest.
#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double SEPARATION_SPEED = 0.1;  // [m/s] of a contact
constexpr double AT_REST = 1e-3;          // [m/s]

/** Outcome of a scene. */
struct Outcome {
  double fastest = 0;       ///< [m/s] of any body's middle, while meshes cross
  double max_of_layer = 0;  ///< while meshes cross
  int unreliable_steps = 0;
  double speed_at_end = 0;  ///< [m/s]
  bool unreliable_at_end = false;
};

Outcome recover(Simulator* simulator, double seconds) {
  Outcome outcome;
  const long steps = std::lround(seconds / simulator->config().time_step);
  for (long i = 0; i < steps; ++i) {
    const StepReport& report = simulator->step();
    EXPECT_FALSE(report.status & STATE_NOT_FINITE) << i;
    double fastest = 0;
    for (const dynamics::BodyState& body : report.bodies) fastest = std::max(fastest, body.v_WCom.norm());
    outcome.unreliable_at_end = report.status & CONTACT_UNRELIABLE;
    outcome.speed_at_end = fastest;
    if (!outcome.unreliable_at_end) continue;
    ++outcome.unreliable_steps;
    outcome.fastest = std::max(outcome.fastest, fastest);
    outcome.max_of_layer = std::max(outcome.max_of_layer, report.max_of_layer);
  }
  return outcome;
}

TEST(Recovery, CubeStartedInABoxRisesSteadily) {
  for (const double depth : {0.001, 0.02}) {
    SimulationConfig config;
    config.environments = {ground()};
    config.objects = {box("block", {0.4, 0.4, 0.2}, 50, {0, 0, 0.1025}),
                      box("cube", Vector3::Constant(0.1), 1, {0.05, 0.03, 0.2025 + 0.05 - depth})};
    Simulator simulator(config, model::UriResolver());
    const Outcome outcome = recover(&simulator, 1);
    EXPECT_NEAR(outcome.max_of_layer, 1 + depth / 0.005, 1e-6);
    EXPECT_LT(outcome.fastest, SEPARATION_SPEED);
    // The cube leaves at that speed while meshes cross, then as much slower as less of the layer is used up, until a quarter is left.
    EXPECT_NEAR(outcome.unreliable_steps, 1e3 * (depth + 0.005 * std::log(4)) / SEPARATION_SPEED, 15);
    EXPECT_FALSE(outcome.unreliable_at_end);
    EXPECT_LT(outcome.speed_at_end, 1e-6);
    EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), 0.2575, 1e-6) << depth;
  }
}

TEST(Recovery, CubesStartedInEachOtherSpreadAndRest) {
  SimulationConfig config;
  config.environments = {ground()};
  for (int i = 0; i < 4; ++i)
    config.objects.push_back(box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0.08 * (i % 2), 0.08 * (i / 2), 0.0525}));
  Simulator simulator(config, model::UriResolver());
  const Outcome outcome = recover(&simulator, 2);
  EXPECT_LT(outcome.fastest, 3 * SEPARATION_SPEED);
  EXPECT_GT(outcome.max_of_layer, 1);
  EXPECT_FALSE(outcome.unreliable_at_end);
  EXPECT_LT(outcome.speed_at_end, AT_REST);
}

/** Five walls of no thickness. */
ObjectConfig tray(const std::string& name, const Vector3& xyz, const Vector3& rpy) {
  geometry::TriangleMesh mesh = geometry::boxMesh({0.1, 0.1, 0.06});
  const auto top = [&mesh](const Vector3i& e) {
    return mesh.vertices[e[0]].z() > 0 && mesh.vertices[e[1]].z() > 0 && mesh.vertices[e[2]].z() > 0;
  };
  mesh.elements.erase(std::remove_if(mesh.elements.begin(), mesh.elements.end(), top), mesh.elements.end());
  ObjectConfig object;
  object.name = name;
  object.uri = meshFile("tray", mesh);
  object.mass = 0.3;
  object.X_WO = makePose(xyz, rpy);
  return object;
}

TEST(Recovery, InterlockedTraysPartAndRest) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {tray("tray1", {0, 0, 0.034}, {0, 0, 0}), tray("tray2", {0.05, 0.012, 0.055}, {0.3, 0.2, 0.5})};
  Simulator simulator(config, model::UriResolver());
  const Outcome outcome = recover(&simulator, 3);
  EXPECT_LT(outcome.fastest, 0.5);
  EXPECT_GT(outcome.unreliable_steps, 0);
  EXPECT_FALSE(outcome.unreliable_at_end);
  EXPECT_LT(outcome.speed_at_end, AT_REST);
}

TEST(Recovery, HandStartedInsideATable) {
  const std::string urdf = R"(<robot name="arm"><link name="base"/>
  <link name="hand">
    <inertial><origin xyz="0.3 0 0"/><mass value="2"/><inertia ixx="0.005" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.35 0 0"/><geometry><box size="0.12 0.08 0.04"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="hand"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="200" velocity="10"/></joint></robot>)";
  SimulationConfig config;
  EnvironmentConfig table;
  table.name = "table";
  table.uri = meshFile("table", geometry::boxMesh({0.6, 0.6, 0.03}));
  table.X_WE = makePose({0.4, 0, 0.4});
  config.environments = {table};
  RobotConfig arm = robot("arm", urdf, true);
  arm.X_WR = makePose({0, 0, 0.425});
  config.robots = {arm};
  Simulator simulator(config, model::UriResolver());
  const Outcome outcome = recover(&simulator, 1.5);
  EXPECT_LT(outcome.fastest, 1.5 * SEPARATION_SPEED);
  EXPECT_GT(outcome.unreliable_steps, 0);
  EXPECT_FALSE(outcome.unreliable_at_end);
  EXPECT_LT(outcome.speed_at_end, AT_REST);
  EXPECT_LT(simulator.report().joints[0].position, -0.01);  // up
}

/** A soft plate shot down at a sheet much faster than its layer can guard against: its middle gets to the wrong side. */
SimulationConfig plateThroughSheet() {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.environments = {ground()};
  config.objects = {box("plate", {0.1, 0.1, 0.004}, 0.1, {0.1, 0.2, 0.02})};
  config.objects[0].linear_velocity = {0, 0, -60};
  for (ContactOverrides* contact : {&config.environments[0].contact, &config.objects[0].contact}) {
    contact->boundary_width = 5e-5;
    contact->stiffness = 10;
    contact->damping = 0.01;
  }
  return config;
}

TEST(Recovery, WhatWasDrivenInComesOutTheWayItCame) {
  Simulator simulator(plateThroughSheet(), model::UriResolver());
  double lowest = 1;
  std::uint32_t status = 0;
  for (int i = 0; i < 20; ++i) {
    status |= simulator.step().status;
    lowest = std::min(lowest, bodyOf(simulator, "plate").X_WB.translation().z());
  }
  ASSERT_TRUE(status & CONTACT_UNRELIABLE);
  ASSERT_TRUE(status & STEP_SHORTENED);
  ASSERT_LT(lowest, -1e-4);
  const Outcome outcome = recover(&simulator, 0.5);
  EXPECT_LT(outcome.fastest, 1.5 * SEPARATION_SPEED);
  EXPECT_FALSE(outcome.unreliable_at_end);
  EXPECT_GT(bodyOf(simulator, "plate").X_WB.translation().z(), 0.0015);
}

TEST(Recovery, IsPartOfTheState) {
  Simulator simulator(plateThroughSheet(), model::UriResolver());
  stepFor(&simulator, 0.02);
  ASSERT_TRUE(simulator.report().status & CONTACT_UNRELIABLE);
  const SimulationState saved = simulator.save();
  const std::uint64_t start = simulator.stateHash();
  stepFor(&simulator, 0.1);
  const std::uint64_t end = simulator.stateHash();
  Simulator other(plateThroughSheet(), model::UriResolver());
  other.restore(saved);
  EXPECT_EQ(other.stateHash(), start);
  stepFor(&other, 0.1);
  EXPECT_EQ(other.stateHash(), end);
  simulator.resetSimulation();
  EXPECT_EQ(simulator.stateHash(), Simulator(plateThroughSheet(), model::UriResolver()).stateHash());
}

TEST(Recovery, StateCutShortIsRefused) {
  Simulator simulator(plateThroughSheet(), model::UriResolver());
  stepFor(&simulator, 0.02);
  const SimulationState whole = simulator.save();
  Simulator other(plateThroughSheet(), model::UriResolver());
  const std::uint64_t untouched = other.stateHash();
  for (const auto& [words, numbers] : {std::pair<int, int>{1, 0}, {3, 0}, {0, 1}, {0, 16}, {3, 16}}) {
    SimulationState cut = whole;
    cut.words.resize(cut.words.size() - words);
    cut.numbers.resize(cut.numbers.size() - numbers);
    try {
      other.restore(cut);
      ADD_FAILURE() << "taken without its last " << words << " words and " << numbers << " numbers";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("cut short"), std::string::npos) << error.what();
    }
    EXPECT_EQ(other.stateHash(), untouched);
  }
}

}  // namespace
}  // namespace blem_sim::sim
