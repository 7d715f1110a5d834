// Scenes of thousands of bodies: they load, step and are told apart without anything that grows faster than their number.
#include <gtest/gtest.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double APART = 0.3;  // [m]

/** Cubes of 0.1 m in a square, just above one ground of two triangles. */
SimulationConfig cubesApart(int count) {
  SimulationConfig config;
  int row = 1;
  while (row * row < count) ++row;
  config.environments = {ground(APART * (row + 2))};
  ObjectConfig cube = box("cube", Vector3::Constant(0.1), 1, Vector3::Zero());
  for (int i = 0; i < count; ++i) {
    cube.name = "cube" + std::to_string(i);
    cube.X_WO = makePose(Vector3(APART * (i % row - 0.5 * row), APART * (i / row - 0.5 * row), 0.0527));
    config.objects.push_back(cube);
  }
  return config;
}

TEST(ManyBodies, ThreeThousandCubesApartRest) {
  constexpr int CUBES = SANITIZED ? 300 : 3000;
  Simulator simulator(cubesApart(CUBES), model::UriResolver());
  stepFor(&simulator, 0.05);
  const StepReport& report = simulator.report();
  EXPECT_EQ(report.status, static_cast<std::uint32_t>(STEP_OK));
  EXPECT_EQ(report.searched_pairs, CUBES);
  EXPECT_EQ(report.reduced_contacts, 4 * CUBES);
  double fastest = 0, lowest = 1, highest = 0;
  for (const dynamics::BodyState& body : report.bodies) {
    fastest = std::max(fastest, body.v_WCom.norm());
    lowest = std::min(lowest, body.X_WB.translation().z());
    highest = std::max(highest, body.X_WB.translation().z());
  }
  EXPECT_LT(fastest, 1e-6);
  EXPECT_NEAR(lowest, 0.0525, 1e-5);
  EXPECT_NEAR(highest, 0.0525, 1e-5);
}

TEST(ManyBodies, ModelsAreFoundByNameWhateverTheirNumber) {
  constexpr int CUBES = 2000;
  Simulator simulator(cubesApart(CUBES), model::UriResolver());
  EXPECT_EQ(simulator.modelIndex("ground"), 0);
  for (int i = 0; i < CUBES; ++i) EXPECT_EQ(simulator.modelIndex("cube" + std::to_string(i)), i + 1);
  EXPECT_EQ(simulator.modelIndex("cube2000"), -1);
  simulator.unloadEnvironment("ground");
  EXPECT_EQ(simulator.modelIndex("ground"), -1);
  simulator.loadEnvironment(ground());
  EXPECT_EQ(simulator.modelIndex("ground"), 0);  // its slot is used again
}

TEST(ManyBodies, MoreModelsThanAreSimulatedAreRefusedInOneLine) {
  SimulationConfig config;
  config.objects.resize(1000000);
  try {
    Simulator simulator(config, model::UriResolver());
    FAIL() << "a million objects were taken";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "objects: 1000000 environments, robots and objects are more than the 100000 that are simulated; give fewer");
  }
}

// Meshes cross from the start: the step says so, stays finite, and crossed bodies part at a bounded speed.
TEST(ManyBodies, AHundredStartedInsideEachOtherIsSaidSo) {
  SimulationConfig config;
  config.environments = {ground(8)};
  for (int i = 0; i < (SANITIZED ? 12 : 100); ++i)
    config.objects.push_back(
        box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, Vector3(0.03 * (i % 6), 0.03 * (i / 6 % 6), 0.06 + 0.03 * (i / 36))));
  Simulator simulator(config, model::UriResolver());
  double fastest = 0;
  for (int k = 0; k < 3; ++k) {
    const StepReport& report = simulator.step();
    EXPECT_TRUE(report.status & CONTACT_UNRELIABLE);
    ASSERT_FALSE(report.status & STATE_NOT_FINITE);
    for (const dynamics::BodyState& body : report.bodies) fastest = std::max(fastest, body.v_WCom.norm());
  }
  EXPECT_LT(fastest, 10);
}

// Faces of copies at one place coincide and cross nowhere, yet the copies are in each other: they say so and get out.
class Copies : public ::testing::TestWithParam<double> {};

TEST_P(Copies, AtOnePlaceGetOutOfEachOther) {
  SimulationConfig config;
  config.environments = {ground()};
  for (const char* name : {"one", "other"}) config.objects.push_back(box(name, Vector3::Constant(0.1), 1, {0, 0, 0.2}));
  config.objects[1].X_WO.translation().x() += GetParam();
  Simulator simulator(config, model::UriResolver());
  EXPECT_TRUE(simulator.step().status & CONTACT_UNRELIABLE);
  stepFor(&simulator, 2);
  EXPECT_FALSE(simulator.report().status & CONTACT_UNRELIABLE);
  const Vector3 apart = bodyOf(simulator, "one").X_WB.translation() - bodyOf(simulator, "other").X_WB.translation();
  // Cubes that do not meet, and turn about the vertical alone, are farther apart than their side along an axis of one of them.
  const auto alongAxesOf = [&](const char* name) {
    return (bodyOf(simulator, name).X_WB.linear().transpose() * apart).lpNorm<Eigen::Infinity>();
  };
  EXPECT_GT(std::max(alongAxesOf("one"), alongAxesOf("other")), 0.1);
  EXPECT_LT(bodyOf(simulator, "one").v_WCom.norm(), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(ManyBodies, Copies, ::testing::Values(0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4));

TEST(ManyBodies, SheetsAtOnePlaceLieOnEachOther) {
  SimulationConfig config;
  config.environments = {ground()};
  for (const char* name : {"one", "other"}) config.objects.push_back(sheet(name, 0.2, 1, makePose({0, 0, 0.05})));
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 2);
  const double apart = bodyOf(simulator, "one").X_WB.translation().z() - bodyOf(simulator, "other").X_WB.translation().z();
  EXPECT_NEAR(std::abs(apart), 0.005, 1e-5);
  EXPECT_LT(bodyOf(simulator, "one").v_WCom.norm(), 1e-6);
}

// Bodies all in one place: the step is finite, says so, and searches fewer pairs than a bound that does not grow as their number squared.
class AtOnePlace : public ::testing::TestWithParam<int> {};

TEST_P(AtOnePlace, AreBounded) {
  constexpr int MOST_PAIRS_OF_ONE = 8;
  const int cubes = GetParam();
  SimulationConfig config;
  config.environments = {ground(8)};
  for (int i = 0; i < cubes; ++i) config.objects.push_back(box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0, 0, 0.2}));
  Simulator simulator(config, model::UriResolver());
  for (int k = 0; k < 3; ++k) {
    const StepReport& report = simulator.step();
    EXPECT_TRUE(report.status & CONTACT_UNRELIABLE);
    EXPECT_TRUE(report.status & CONTACTS_REDUCED);
    ASSERT_FALSE(report.status & STATE_NOT_FINITE);
    EXPECT_EQ(report.substeps + report.redone_solves, 1);
    EXPECT_GT(report.searched_pairs, cubes);
    EXPECT_LE(report.searched_pairs, cubes * MOST_PAIRS_OF_ONE / 2 + cubes);
    for (const dynamics::BodyState& body : report.bodies) EXPECT_LT(body.v_WCom.norm(), 10);
  }
  const SimulationState saved = simulator.save();
  simulator.step();
  const std::uint64_t hash = simulator.stateHash();
  simulator.restore(saved);
  simulator.step();
  EXPECT_EQ(simulator.stateHash(), hash);
}

INSTANTIATE_TEST_SUITE_P(ManyBodies, AtOnePlace, ::testing::Values(60, SANITIZED ? 30 : 200));

}  // namespace
}  // namespace blem_sim::sim
