// Cylinders that roll on rails, over gaps and seams, below plates and on each other, against closed forms.
#include <algorithm>
#include <cmath>

#include "sim/cylinder_scene.h"
#include "support/range.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double LAYER_OF_LOG = 0.001;  // [m]
constexpr double ROLLS_AT = 0.05;       // [m]
const SolidCylinder LOG{ROLLS_AT, 0.3, 2};
constexpr double SLOPE = 0.1;  // [rad]
const Vector3 DOWNHILL = G * Vector3(std::sin(SLOPE), 0, -std::cos(SLOPE));

/** Heights [m] of a body's middle. */
Range rollOn(Simulator* simulator, int steps, const std::string& model) {
  Range seen;
  for (int i = 0; i < steps; ++i) {
    simulator->step();
    seen.add(bodyOf(*simulator, model).X_WB.translation().z());
  }
  return seen;
}

/** A drum of 1 m turns by a side of its mesh in 0.1 m; the sides lie 1.2 mm below its mantle. */
TEST(RollingCylinders, ALargeDrumRollsLevelHoweverSlow) {
  const SolidCylinder drum{1, 0.5, 100};
  for (const double speed : {0.05, 1.0}) {
    for (const double layer : {0.0002, 0.0025}) {
      SimulationConfig config = roundConfig(0.5, layer);
      config.environments = {level()};
      config.objects = {cylinderAlongY("drum", drum, {0, 0, drum.radius})};
      roll(speed, drum.radius, &config.objects[0]);
      Simulator simulator(config, model::UriResolver());
      EXPECT_LT(rollOn(&simulator, static_cast<int>(0.25 / speed / config.time_step), "drum").width(), 1e-7) << speed << " " << layer;
      EXPECT_NEAR(bodyOf(simulator, "drum").v_WCom.x(), speed, 1e-6 * speed) << speed << " " << layer;
    }
  }
}

/** Rails narrower than a side of the mesh, and ones that are sharp. */
TEST(RollingCylinders, ALogRollsDownRails) {
  for (const double radius : {0.05, 1.0})
    for (const double width : {0.0, 0.004}) {
      const SolidCylinder log{radius, 0.5, 3};
      SimulationConfig config = roundConfig(0.8, LAYER_OF_LOG);
      config.gravity = DOWNHILL;
      for (const double y : {-0.1, 0.15}) {
        config.environments.push_back(block(fmt::format("rail{}", y), {6, std::max(width, 0.05), 0.02}, {2.5, y, 0}));
        if (width == 0) {  // on its edge
          config.environments.back().X_WE = makePose({2.5, y, -0.05 / std::sqrt(2.0)}, {M_PI / 4, 0, 0});
          config.environments.back().uri = meshFile("square_rail", geometry::boxMesh({6, 0.05, 0.05}));
        }
      }
      config.objects = {cylinderAlongY("log", log, {0, 0, radius})};
      Simulator simulator(config, model::UriResolver());
      rollOn(&simulator, 100, "log");
      const double start = bodyOf(simulator, "log").v_WCom.x();
      const Range seen = rollOn(&simulator, 1000, "log");
      const double theory = G * std::sin(SLOPE) / 1.5;
      EXPECT_NEAR(bodyOf(simulator, "log").v_WCom.x() - start, theory, 1e-5) << radius << " " << width;
      EXPECT_LT(seen.width(), 1e-6) << radius << " " << width;
    }
}

/** A groove of two planes at 45 degrees: both contacts slip under N (1 + mu^2) sqrt 2 = m g. */
TEST(RollingCylinders, ALogThatSpinsInAGrooveIsBrakedByBothSides) {
  constexpr double FRICTION = 0.3, SPIN = 200;
  SimulationConfig config = roundConfig(FRICTION, LAYER_OF_LOG);
  for (const double side : {-1, 1}) {
    config.environments.push_back(level());
    config.environments.back().name = fmt::format("plane{}", side);
    config.environments.back().plane = Eigen::Vector4d(side, 0, 1, 0);
  }
  config.objects = {cylinderAlongY("log", LOG, {0, 0, ROLLS_AT * std::sqrt(2.0)})};
  config.objects[0].angular_velocity = {0, SPIN, 0};
  Simulator simulator(config, model::UriResolver());
  rollOn(&simulator, 100, "log");
  const double start = bodyOf(simulator, "log").w_WB.y();
  const Range seen = rollOn(&simulator, 500, "log");
  const double theory = FRICTION * ROLLS_AT * LOG.mass * G * std::sqrt(2.0) / (1 + FRICTION * FRICTION) / LOG.along();
  EXPECT_NEAR((start - bodyOf(simulator, "log").w_WB.y()) / 0.5, theory, 1e-4 * theory);
  EXPECT_LT(seen.width(), 1e-6);
}

/** The log turns about one edge, then about the other [McGeer 1990]; layers only round the edges. */
TEST(RollingCylinders, ALogRollsOverAGapBetweenBoxes) {
  constexpr double GAP = 0.02, SPEED = 1;
  SimulationConfig config = roundConfig(1, 1e-4);
  config.time_step = 2e-4;
  for (const double side : {-1, 1})
    config.environments.push_back(block(fmt::format("box{}", side), {1, 1, 0.1}, {side * (0.5 + GAP / 2), 0, 0}));
  const SolidCylinder log{0.1, 0.3, 2};
  config.objects = {cylinderAlongY("log", log, {-0.2, 0, 0.1})};
  roll(SPEED, 0.1, &config.objects[0]);
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.4);
  const double turned = 2 * std::asin(GAP / 2 / 0.1), drop = 0.1 * (1 - std::cos(turned / 2)), inertia = log.along() + log.mass * 0.01;
  const double down = SPEED * SPEED + 2 * log.mass * G * drop * 0.01 / inertia;
  const double lost = std::pow((log.along() + log.mass * 0.01 * std::cos(turned)) / inertia, 2);
  EXPECT_NEAR(bodyOf(simulator, "log").v_WCom.x(), std::sqrt(down * lost - (down - SPEED * SPEED)), 1e-3);
  EXPECT_NEAR(bodyOf(simulator, "log").X_WB.translation().z(), 0.1, 1e-5);
}

/** A valley that turns by less than a side of the log's mesh: the log hits its far side as McGeer's wheel would, nowhere deeper. */
TEST(RollingCylinders, ALargeLogRollsThroughAShallowValley) {
  constexpr double TURN = 0.02, SPEED = 1;
  const SolidCylinder log{0.5, 0.5, 10};
  const double bottom = -log.radius * std::tan(TURN / 2), start = bottom - 0.1;
  EnvironmentConfig valley;
  valley.name = "valley";
  geometry::TriangleMesh mesh = geometry::gridMesh(4, 1, 2, 1);
  for (Vector3& v : mesh.vertices) v.z() = std::max(0.0, v.x()) * std::tan(TURN);
  valley.uri = meshFile("valley", mesh);
  for (const double turned : {0.0, 0.04, 0.09}) {
    SimulationConfig config = roundConfig(0.8, LAYER_OF_LOG);
    config.environments = {valley};
    config.objects = {cylinderAlongY("log", log, {start, 0, log.radius})};
    config.objects[0].X_WO = config.objects[0].X_WO * makePose({0, 0, 0}, {0, 0, turned});
    roll(SPEED, log.radius, &config.objects[0]);
    Simulator simulator(config, model::UriResolver());
    double deepest = 0;
    for (int i = 0; i < 200; ++i)
      for (const ContactReport& contact : simulator.step().contacts) deepest = std::max(deepest, contact.depth);
    EXPECT_LT(deepest, 1e-8) << turned;
    const double theory = SPEED * (std::cos(TURN) + 0.5) / 1.5 - G * std::sin(TURN) / 1.5 * 0.1 / SPEED;
    EXPECT_NEAR(bodyOf(simulator, "log").v_WCom.norm(), theory, 1e-4) << turned;
  }
}

TEST(RollingCylinders, ACanRollsDownStepsStraightAndGainsNothing) {
  const SolidCylinder can{0.041, 0.1, 0.4};
  for (const double restitution : {0.0, 0.5}) {
    SimulationConfig config = roundConfig(0.6, LAYER_OF_LOG);
    config.contact.surface.restitution = restitution;
    for (int i = 0; i < 5; ++i)
      config.environments.push_back(block(fmt::format("step{}", i), {i == 0 ? 1.0 : 0.3, 1, 2}, {i == 0 ? -0.35 : 0.3 * i, 0, -0.1 * i}));
    config.objects = {cylinderAlongY("can", can, {-0.1, 0, 0.041})};
    roll(0.3, 0.041, &config.objects[0]);
    Simulator simulator(config, model::UriResolver());
    const double start = simulator.report().energy;
    double gained = 0;
    for (int i = 0; i < 2500; ++i) {
      const StepReport& report = simulator.step();
      gained += report.energy_gained;
      ASSERT_LT(report.energy - start - gained, 1e-6) << restitution << " " << i;
    }
    EXPECT_LT(gained, 1e-4) << restitution;
    const Vector3 end = bodyOf(simulator, "can").X_WB.translation();
    EXPECT_LT(end.z(), -0.05) << restitution;
    EXPECT_NEAR(end.y(), 0, 1e-5) << restitution;
  }
}

/** The middle goes half as fast as the plate on top. */
TEST(RollingCylinders, APlateOnRollersRollsDownASlope) {
  for (const double time_step : {1e-3, 5e-3}) {
    SimulationConfig config = roundConfig(0.8, LAYER_OF_LOG);
    config.time_step = time_step;
    config.gravity = DOWNHILL;
    config.environments = {level()};
    for (int i = 0; i < 4; ++i) config.objects.push_back(cylinderAlongY(fmt::format("log{}", i), LOG, {0.2 * i, 0, ROLLS_AT}));
    constexpr double PLATE = 5;
    config.objects.push_back(box("plate", {2, 0.2, 0.02}, PLATE, {0.3, 0, 2 * ROLLS_AT + 0.01 + LAYER_OF_LOG}));
    Simulator simulator(config, model::UriResolver());
    stepFor(&simulator, 0.1);
    const double start = bodyOf(simulator, "plate").v_WCom.x(), start_of_log = bodyOf(simulator, "log1").v_WCom.x();
    stepFor(&simulator, 0.5);
    const double theory =
        G * std::sin(SLOPE) * (PLATE + 4 * LOG.mass / 2) / (PLATE + 4 * 0.25 * (LOG.mass + LOG.along() / (ROLLS_AT * ROLLS_AT)));
    EXPECT_NEAR((bodyOf(simulator, "plate").v_WCom.x() - start) / 0.5, theory, 1e-4 * theory) << time_step;
    EXPECT_NEAR((bodyOf(simulator, "log1").v_WCom.x() - start_of_log) / 0.5, theory / 2, 1e-4 * theory) << time_step;
  }
}

/** Plates that motors move against each other, the upper one pressed down by its weight. */
TEST(RollingCylinders, ALogBetweenPlatesThatMoveGoesAtTheirMean) {
  const std::string plate = boxText({2, 0.3, 0.02}, 5);
  RobotConfig press = machine(
      "press",
      jointedText("lower", "prismatic", R"(xyz="0 0 -0.011")", "1 0 0", plate) +
          jointedText("slide", "prismatic", R"(xyz="0 0 0.2")", "1 0 0", boxText({0.01, 0.01, 0.01}, 1)) +
          fmt::format(R"(<link name="upper">{}</link><joint name="press" type="prismatic"><parent link="slide"/><child link="upper"/>)"
                      R"(<origin xyz="0 0 -0.089"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1e6" velocity="1e6"/></joint>)",
                      plate));
  press.motor["default"] = MotorLaw::IMPLICIT_PD;
  for (const char* joint : {"lower_joint", "slide_joint"}) press.gains[joint] = {0, 0, 1e5};
  SimulationConfig config = roundConfig(0.5, LAYER_OF_LOG);
  config.robots = {press};
  config.objects = {cylinderAlongY("left", LOG, {-0.3, 0, ROLLS_AT}), cylinderAlongY("right", LOG, {0.3, 0, ROLLS_AT})};
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"lower_joint", "slide_joint"}, {}, {-0.3, 0.5}, {}});
  stepFor(&simulator, 1);
  for (const char* name : {"left", "right"}) {
    EXPECT_NEAR(bodyOf(simulator, name).v_WCom.x(), 0.1, 1e-4) << name;
    EXPECT_NEAR(bodyOf(simulator, name).w_WB.y(), 0.4 / ROLLS_AT, 4e-3) << name;
  }
}

/** Edges of triangles at all angles pass below at 20 m/s. */
TEST(RollingCylinders, ALogRollsOverSeamsAtSpeed) {
  constexpr double SPEED = 20;
  EnvironmentConfig seams;
  seams.name = "seams";
  geometry::TriangleMesh mesh = geometry::gridMesh(24, 0.6, 240, 7);
  for (Vector3& v : mesh.vertices)
    if (std::abs(v.x()) < 11.9 && std::abs(v.y()) < 0.29)
      v += Vector3(0.03 * std::sin(917 * v.x() + v.y()), 0.02 * std::sin(533 * v.x()), 0);
  seams.uri = meshFile("seams", mesh);
  EnvironmentConfig left = ground(12), right = ground(12);
  left.X_WE = makePose({-6, 0, 0});
  right.X_WE = makePose({6, 0, 0});
  right.name = "right";
  struct Track {
    std::vector<EnvironmentConfig> floors;
    double askew;  ///< [rad]
  };
  const double way = SANITIZED ? 5 : 20;  // [m] with the middle at the origin: fifty seams, or two hundred
  for (const auto& [floors, askew] : {Track{{seams}, 0}, Track{{left, right}, 0}, Track{{left, right}, 0.3}}) {
    SimulationConfig config = roundConfig(0.5, LAYER_OF_LOG);
    config.environments = floors;
    config.objects = {cylinderAlongY("log", LOG, {-0.5 * way, 0, ROLLS_AT})};
    roll(SPEED, ROLLS_AT, &config.objects[0]);
    ObjectConfig& log = config.objects[0];
    const Pose turn = makePose({0, 0, 0}, {0, 0, askew});
    log.X_WO = turn * log.X_WO;
    log.linear_velocity = turn.linear() * log.linear_velocity;
    log.angular_velocity = turn.linear() * log.angular_velocity;
    Simulator simulator(config, model::UriResolver());
    EXPECT_LT(rollOn(&simulator, static_cast<int>(std::lround(way / SPEED / config.time_step)), "log").width(), 1e-7)
        << askew << " " << floors.size();
    EXPECT_NEAR(bodyOf(simulator, "log").v_WCom.norm(), SPEED, 1e-6) << askew << " " << floors.size();
  }
}

/** A driven roller turns a log, and that another roller, without slip. */
TEST(RollingCylinders, ATrainOfRollersTurnsAsOne) {
  const SolidCylinder roller{0.04, 0.2, 1};
  const double height = std::sqrt(std::pow(ROLLS_AT + 0.04, 2) - 0.06 * 0.06);
  RobotConfig rollers = machine(
      "rollers", jointedText("first", "continuous", std::string(R"(xyz="-0.06 0 0" )") + ALONG_Y, "0 0 1", cylinderText(roller)) +
                     jointedText("second", "continuous", std::string(R"(xyz="0.06 0 0" )") + ALONG_Y, "0 0 1", cylinderText(roller)));
  rollers.motor["default"] = MotorLaw::IMPLICIT_PD;
  rollers.gains["first_joint"] = {0, 0, 100};
  SimulationConfig config = roundConfig(0.5, LAYER_OF_LOG);
  config.robots = {rollers};
  config.objects = {cylinderAlongY("log", LOG, {0, 0, height})};
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"first_joint"}, {}, {5}, {}});
  stepFor(&simulator, 1);
  const double rim = 5 * 0.04;
  EXPECT_NEAR(bodyOf(simulator, "log").w_WB.y(), -rim / ROLLS_AT, 1e-4);
  EXPECT_NEAR(simulator.world().jointState(simulator.robots()[0].joints[1]).velocity, rim / 0.04, 1e-4);
  EXPECT_NEAR(bodyOf(simulator, "log").X_WB.translation().x(), 0, 1e-4);
}

}  // namespace
}  // namespace blem_sim::sim
