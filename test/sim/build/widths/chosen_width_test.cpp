// Boundary widths that are chosen at load: `boundary_width: auto`.
#include "build/widths/chosen_width.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

/** A part that no need but the one of a test widens: 1 m large, at a step of 1 us. */
WidthNeeds largePart() {
  WidthNeeds needs;
  needs.side = 1;
  needs.moves = true;
  needs.time_step = 1e-6;
  return needs;
}

TEST(ChosenWidth, IsTheLargestNeed) {
  WidthNeeds needs = largePart();
  needs.time_step = 0.002;
  EXPECT_DOUBLE_EQ(chosenWidth(needs).width, 0.002);
  needs.noise = 0.001;
  EXPECT_DOUBLE_EQ(chosenWidth(needs).width, 0.003);
  EXPECT_EQ(chosenWidth(needs).why, "three deviations of its noise");
  needs.weight = 20;
  needs.stiffness = 1e4;
  EXPECT_DOUBLE_EQ(chosenWidth(needs).width, 0.004);
  EXPECT_EQ(chosenWidth(needs).why, "twice what its weight presses its surface in");
}

TEST(ChosenWidth, KeepsTheShapeOfWhatMoves) {
  WidthNeeds needs = largePart();
  needs.time_step = 0.001;
  needs.side = 0.01;
  EXPECT_DOUBLE_EQ(chosenWidth(needs).width, 0.0005);
  EXPECT_EQ(chosenWidth(needs).why, "a twentieth of its smallest side; the way of 1 m/s in a time step would be 1 mm");
  needs.side = 0;
  EXPECT_DOUBLE_EQ(chosenWidth(needs).width, 0.001) << "a segment, a half-space";
}

TEST(ChosenWidth, OfEnvironmentsIsForTheirNoiseAlone) {
  WidthNeeds needs = largePart();
  needs.moves = false;
  needs.time_step = 0.01;
  needs.weight = 100;
  needs.stiffness = 1000;
  EXPECT_EQ(chosenWidth(needs).width, 0);
  EXPECT_EQ(chosenWidth(needs).why, "its noise is nothing, or cannot be told");
  needs.noise = 0.0004;
  EXPECT_DOUBLE_EQ(chosenWidth(needs).width, 0.0012);
  needs.noise = 0.1;
  EXPECT_DOUBLE_EQ(chosenWidth(needs).width, 0.005);
  EXPECT_EQ(chosenWidth(needs).why, "the most for an environment; three deviations of its noise would be 300 mm");
}

TEST(ChosenWidth, SheetsHaveNoSmallestSide) {
  EXPECT_DOUBLE_EQ(smallestSide(geometry::boxMesh({0.3, 0.1, 0.2}), true), 0.1);
  EXPECT_DOUBLE_EQ(smallestSide(geometry::gridMesh(0.3, 0.2, 1, 1), false), 0.2);
}

/** A floor of 2 m with noise [m] of heights. */
EnvironmentConfig noisyFloor(double noise) {
  geometry::TriangleMesh mesh = geometry::gridMesh(2, 2, 150, 150);
  std::mt19937 random(1);
  std::normal_distribution<double> height(0, noise);
  for (Vector3& v : mesh.vertices) v.z() = height(random);
  EnvironmentConfig floor;
  floor.name = "floor";
  floor.uri = meshFile("noisy_floor", mesh);
  return floor;
}

std::string widthNote(const Simulator& simulator, std::size_t row) {
  for (const std::string& note : simulator.loadReport()[row].notes)
    if (note.find("boundary_width: auto") == 0) return note;
  return "";
}

TEST(ChosenWidth, IsWhatSimulatesAndIsReported) {
  SimulationConfig config;
  config.contact.boundary_width = BoundaryWidth::chosen();
  config.environments = {noisyFloor(0.0005), ground()};
  config.environments[1].contact.boundary_width = 0.002;
  config.objects = {box("large", Vector3::Constant(0.1), 1, {0, 0, 0.06}), box("part", Vector3::Constant(0.001), 1e-5, {0.5, 0, 0.06}),
                    box("fixed", Vector3::Constant(0.1), 1, {0, 0.5, 0.06}), box("soft", Vector3::Constant(0.2), 10, {0, -0.5, 0.2})};
  config.objects[2].contact.boundary_width = 0.003;
  config.objects[3].contact.stiffness = 1e5;
  config.objects[3].contact.boundary_width = BoundaryWidth::chosen();
  Simulator simulator(config, model::UriResolver());
  const auto& colliders = simulator.colliders();
  EXPECT_NEAR(colliders[0].radius, 0.0015, 0.0001);
  EXPECT_EQ(colliders[1].radius, 0.002);
  EXPECT_DOUBLE_EQ(colliders[2].radius, 0.001);
  EXPECT_NEAR(colliders[3].radius, 0.00005, 1e-11);
  EXPECT_EQ(colliders[4].radius, 0.003);
  EXPECT_NEAR(colliders[5].radius, 2 * 10 * G / 1e5, 1e-12);
  for (std::size_t i = 0; i < colliders.size(); ++i) EXPECT_EQ(simulator.loadReport()[i].boundary_width, colliders[i].radius);
  EXPECT_NE(widthNote(simulator, 0).find("three deviations of its noise"), std::string::npos);
  EXPECT_EQ(widthNote(simulator, 1), "");
  EXPECT_EQ(widthNote(simulator, 2), "boundary_width: auto is 1 mm: the way of 1 m/s in a time step");
  EXPECT_NE(widthNote(simulator, 3).find("0.05 mm: a twentieth of its smallest side"), std::string::npos);
  EXPECT_EQ(widthNote(simulator, 4), "");
}

TEST(ChosenWidth, OfARobotIsForEachShapeOfALink) {
  SimulationConfig config;
  config.robots = {robot("r", R"(<robot name="r"><link name="base"><inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0"
    ixz="0" iyz="0"/></inertial><collision><geometry><box size="0.3 0.3 0.2"/></geometry></collision>
    <collision><geometry><box size="0.3 0.3 0.004"/></geometry></collision></link></robot>)",
                         false)};
  config.robots[0].links["base"].boundary_width = BoundaryWidth::chosen();
  const Simulator simulator(config, model::UriResolver());
  EXPECT_DOUBLE_EQ(simulator.colliders()[0].radius, 0.001);
  EXPECT_NEAR(simulator.colliders()[1].radius, 0.0002, 1e-12);
}

// Small rounded parts bend from vertex to vertex as noise does.
TEST(ChosenWidth, NoiseIsOfScansAlone) {
  geometry::TriangleMesh rough = geometry::icosphereMesh(0.1, 3);
  for (std::size_t i = 0; i < rough.vertices.size(); ++i) rough.vertices[i] *= i % 2 == 0 ? 1 : 1.03;
  SimulationConfig config;
  config.contact.boundary_width = BoundaryWidth::chosen();
  config.objects = {box("closed", Vector3::Ones(), 1, {0, 0, 1}), box("open", Vector3::Ones(), 1, {1, 0, 1})};
  config.objects[0].uri = meshFile("rough", rough);
  rough.elements.pop_back();
  config.objects[1].uri = meshFile("rough_open", rough);
  config.robots = {robot("drawn",
                         R"(<robot name="drawn"><link name="base"><inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0"
    ixz="0" iyz="0"/></inertial><collision><geometry><mesh filename="file://)" +
                             config.objects[1].uri + R"("/></geometry></collision>
    </link></robot>)",
                         false)};
  const Simulator simulator(config, model::UriResolver());
  EXPECT_DOUBLE_EQ(simulator.colliders()[0].radius, 0.001) << "of the robot";
  EXPECT_DOUBLE_EQ(simulator.colliders()[1].radius, 0.001) << "closed";
  EXPECT_GT(simulator.colliders()[2].radius, 0.003);
}

// Small and large things rest on noise, none of them beyond its layer.
TEST(ChosenWidth, CarriesPartsOnAScan) {
  SimulationConfig config;
  config.contact.boundary_width = BoundaryWidth::chosen();
  config.environments = {noisyFloor(0.0005)};
  double x = -0.6;
  for (const double side : {0.004, 0.02, 0.1, 0.3}) {
    config.objects.push_back(
        box("cube" + std::to_string(config.objects.size()), Vector3::Constant(side), 500 * side * side * side, {x, 0, 0.5 * side + 0.004}));
    x += 0.3;
  }
  Simulator simulator(config, model::UriResolver());
  double most = 0;
  for (int i = 0; i < 3000; ++i) most = std::max(most, simulator.step().max_of_layer);
  EXPECT_LT(most, 1);
  for (const ObjectConfig& object : config.objects) {
    const dynamics::BodyState state = bodyOf(simulator, object.name);
    EXPECT_LT(state.v_WCom.norm(), 1e-6) << object.name;
    EXPECT_GT(state.X_WB.translation().z(), -0.001) << object.name;
  }
}

}  // namespace
}  // namespace blem_sim::sim
