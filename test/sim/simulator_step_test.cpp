// Motion of bodies under the step: fall, rest, roll, stack.
#include <cmath>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

TEST(SimulatorStep, FreeFall) {
  SimulationConfig config;
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 10})};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 1);
  // Velocity first, then position: dt g t / 2 more than the parabola.
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), 10 - 0.5 * G - 0.5 * G * 1e-3, 1e-9);
  EXPECT_NEAR(bodyOf(simulator, "cube").v_WCom.z(), -G, 1e-9);
  EXPECT_EQ(simulator.steps(), 1000u);
  EXPECT_DOUBLE_EQ(simulator.report().time, 1);
}

TEST(SimulatorStep, DroppedCubeRestsOnItsLayer) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.01, 0.02, 0.0625})};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 1);
  const Pose early = bodyOf(simulator, "cube").X_WB;
  EXPECT_NEAR(early.translation().z(), 0.0525, 2e-6);
  stepFor(&simulator, 2);
  const Pose late = bodyOf(simulator, "cube").X_WB;
  EXPECT_LT((late.translation() - early.translation()).norm(), 1e-7);
  Vector3 sum = Vector3::Zero();
  for (const ContactReport& contact : simulator.report().contacts) {
    // a < b: the ground is A, and its push on it is down.
    EXPECT_EQ(contact.body_a, dynamics::WORLD_BODY);
    EXPECT_NEAR(contact.normal_BA.z(), -1, 1e-9);
    sum += contact.force;
  }
  EXPECT_NEAR(sum.z(), -G, 1e-6);
  EXPECT_EQ(simulator.report().status, STEP_OK);
  EXPECT_EQ(simulator.report().substeps, 1);
  EXPECT_EQ(simulator.report().reduced_contacts, 4);
}

TEST(SimulatorStep, ThreeCubesStackWithinATenthOfAMillimetre) {
  SimulationConfig config;
  config.environments = {ground()};
  for (int i = 0; i < 3; ++i)
    config.objects.push_back(box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0.002 * i, -0.002 * i, 0.0625 + 0.115 * i}));
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 5);
  for (int i = 0; i < 3; ++i) {
    const Vector3 p = bodyOf(simulator, "cube" + std::to_string(i)).X_WB.translation();
    EXPECT_NEAR(p.z(), 0.0525 + 0.105 * i, 1e-4);
    EXPECT_NEAR(p.x(), 0.002 * i, 1e-4);
    EXPECT_NEAR(p.y(), -0.002 * i, 1e-4);
    EXPECT_LT(bodyOf(simulator, "cube" + std::to_string(i)).v_WCom.norm(), 1e-6);
  }
}

TEST(SimulatorStep, BallRollsDownASlopeWithoutSlipping) {
  // A point with a layer of 0.1 m is a ball; on a slope of 10 degrees it gains 5/7 g sin(slope).
  const double slope = 10 * M_PI / 180;
  SimulationConfig config;
  EnvironmentConfig plane;
  plane.name = "slope";
  plane.plane = Eigen::Vector4d(std::sin(slope), 0, std::cos(slope), 0);
  config.environments = {plane};
  ObjectConfig ball;
  ball.name = "ball";
  ball.uri = pointsFile("one_point", {Vector3::Zero()});
  ball.cloud.as = model::CloudOptions::As::POINTS;
  ball.cloud.point_radius = 0.1;
  ball.mass = 1;
  ball.com = Vector3::Zero();
  ball.inertia = Matrix3(0.4 * 0.01 * Matrix3::Identity());
  ball.X_WO = makePose(0.1 * Vector3(std::sin(slope), 0, std::cos(slope)));
  config.objects = {ball};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 1);
  const dynamics::BodyState state = bodyOf(simulator, "ball");
  EXPECT_NEAR(state.v_WCom.norm(), 5.0 / 7 * G * std::sin(slope), 0.01 * G * std::sin(slope));
  EXPECT_NEAR(state.w_WB.y() * 0.1, state.v_WCom.norm(), 1e-4);
}

TEST(SimulatorStep, PointCloudCarriesABox) {
  std::vector<Vector3> points;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j) points.emplace_back(0.01 * i, 0.01 * j, 0);
  SimulationConfig config;
  config.environments = {pointCloud("cloud", points)};
  config.environments[0].cloud.point_radius = 0.004;
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.003, 0.004, 0.06})};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 1);
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), 0.05 + 0.0025 + 0.004, 1e-5);
  EXPECT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 1e-5);
  ASSERT_EQ(simulator.loadReport().size(), 2u);
  EXPECT_EQ(simulator.loadReport()[0].name, "cloud");
  EXPECT_EQ(simulator.loadReport()[0].points, 41 * 41);
  EXPECT_DOUBLE_EQ(simulator.loadReport()[0].boundary_width, 0.004);
}

TEST(SimulatorStep, CountsContactsBeforeAndAfterReduction) {
  SimulationConfig config;
  EnvironmentConfig fine = ground();
  fine.uri = meshFile("fine_ground", geometry::gridMesh(0.4, 0.4, 20, 20));
  config.environments = {fine};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.003, 0.001, 0.0525})};
  config.objects[0].max_contacts = 3;
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  EXPECT_GE(simulator.report().raw_contacts, 4);
  EXPECT_EQ(simulator.report().reduced_contacts, 3);
  EXPECT_TRUE(simulator.report().status & CONTACTS_REDUCED);
}

TEST(SimulatorStep, EnergyIsKineticAndPotential) {
  SimulationConfig config;
  config.objects = {box("cube", Vector3::Constant(0.1), 2, {0, 0, 3})};
  config.objects[0].linear_velocity = {4, 0, 0};
  Simulator simulator(config, model::UriResolver());
  EXPECT_NEAR(simulator.report().energy, 2 * G * 3 + 16, 1e-9);
}

TEST(SimulatorStep, NonFiniteStateStopsAtTheLastFiniteOne) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 1}), box("rocket", Vector3::Constant(0.1), 1e-9, {0, 1, 1})};
  Simulator simulator(config, model::UriResolver());
  tearAway("rocket", &simulator);
  const Pose before = bodyOf(simulator, "cube").X_WB;
  for (int i = 0; i < 3; ++i) EXPECT_NO_THROW(simulator.step());
  EXPECT_TRUE(simulator.report().status & STATE_NOT_FINITE);
  EXPECT_LT(simulator.steps(), 3u);
  EXPECT_EQ(simulator.time(), simulator.report().time);
  EXPECT_TRUE(bodyOf(simulator, "cube").X_WB.matrix().allFinite());
  EXPECT_TRUE(bodyOf(simulator, "rocket").v_WCom.allFinite());
  const std::uint64_t steps = simulator.steps();
  simulator.step();
  EXPECT_EQ(simulator.steps(), steps);
  simulator.resetWorld();
  EXPECT_EQ(bodyOf(simulator, "cube").X_WB.matrix(), before.matrix());
  EXPECT_FALSE(simulator.report().status & STATE_NOT_FINITE);
}

TEST(SimulatorStep, ProfileHasEveryStage) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.0525})};
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  for (int stage = 0; stage < static_cast<int>(Stage::COUNT); ++stage)
    EXPECT_GT(simulator.report().profile.seconds[stage], 0) << STAGE_NAMES[stage];
}

}  // namespace
}  // namespace blem_sim::sim
