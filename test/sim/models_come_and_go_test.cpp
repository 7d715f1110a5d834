// Robots and objects that are spawned and removed while the others go on, and what acts on them from outside.
#include <cmath>
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/named_parts.h"
#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr int CYCLES = SANITIZED ? 100 : 1000;

SimulationConfig cubeOn(const char* stepper = "articulated") {
  SimulationConfig config;
  config.solver.stepper = stepper;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.0525})};
  return config;
}

RobotConfig pendulumAt(const std::string& name, const Vector3& place) {
  RobotConfig config = robot(name, pendulumUrdf(), true);
  config.X_WR = makePose(place);
  SensorConfig imu;
  imu.name = "imu";
  imu.link = "arm";
  imu.noise[0].stddev = 0.1;
  config.sensors = {imu};
  return config;
}

/** The order of quick_step's sweeps is drawn for all models together, so it is left out. */
TEST(ModelsComeAndGo, TheOthersKeepTheirBits) {
  for (const char* stepper : {"articulated", "world_step"}) {
    Simulator alone(cubeOn(stepper), model::UriResolver()), visited(cubeOn(stepper), model::UriResolver());
    for (int i = 0; i < 20; ++i) {
      alone.step();
      visited.step();
      visited.spawn(pendulumAt("guest", {3, 0, 0}));
      alone.step();
      visited.step();
      visited.removeModel("guest");
      ASSERT_EQ(bodyOf(alone, "cube").X_WB.matrix(), bodyOf(visited, "cube").X_WB.matrix()) << stepper << " " << i;
    }
    alone.step();
    visited.step();
    EXPECT_EQ(alone.stateHash(), visited.stateHash()) << stepper;
  }
}

TEST(ModelsComeAndGo, SlotsAreUsedAgainHoweverOften) {
  Simulator simulator(cubeOn(), model::UriResolver());
  for (int i = 0; i < CYCLES; ++i) {
    simulator.spawn(pendulumAt("guest", {3, 0, 0}));
    if (i % 10 == 0) simulator.step();
    simulator.removeModel("guest");
  }
  const StepReport& report = simulator.step();
  EXPECT_EQ(report.status & JOINT_LIMIT_HIT, 0u);
  EXPECT_EQ(simulator.models().size(), 3u);
  EXPECT_EQ(simulator.world().jointCount(), 1);
  EXPECT_EQ(simulator.loadReport().size(), 2u);
  EXPECT_TRUE(simulator.robots().empty());
  EXPECT_TRUE(simulator.sensors().empty());
  EXPECT_TRUE(report.samples.empty());
}

TEST(ModelsComeAndGo, SensorsGoByTheirRobotsWhoeverLeaves) {
  SimulationConfig config = cubeOn();
  for (const char* name : {"a", "b", "c"}) config.robots.push_back(pendulumAt(name, {0, 3, 0}));
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  simulator.removeModel("b");
  simulator.spawn(pendulumAt("d", {0, 4, 0}));
  ASSERT_EQ(simulator.robots().size(), 3u);
  EXPECT_EQ(simulator.robots()[1].name, "d");
  const StepReport& report = simulator.step();
  ASSERT_EQ(report.samples.size(), 3u);
  std::vector<std::string> owners;
  for (const SensorInfo& sensor : simulator.sensors()) owners.push_back(simulator.robots()[sensor.robot].name);
  EXPECT_EQ(owners, (std::vector<std::string>{"a", "c", "d"}));
}

TEST(ModelsComeAndGo, ResetGoesToWhereTheyWereSpawned) {
  Simulator simulator(cubeOn(), model::UriResolver()), fresh(cubeOn(), model::UriResolver());
  for (Simulator* each : {&simulator, &fresh}) each->spawn(pendulumAt("guest", {3, 0, 0}));
  stepFor(&simulator, 0.3);
  simulator.setJointPositions(0, {"guest::hinge"}, {1.0});
  stepFor(&simulator, 0.1);
  simulator.resetSimulation();
  EXPECT_EQ(simulator.stateHash(), fresh.stateHash());
  stepFor(&simulator, 0.2);
  stepFor(&fresh, 0.2);
  EXPECT_EQ(simulator.stateHash(), fresh.stateHash());
}

TEST(ModelsComeAndGo, BadOnesChangeNothing) {
  Simulator simulator(cubeOn(), model::UriResolver());
  simulator.step();
  const std::uint64_t hash = simulator.stateHash();
  EXPECT_THROW(simulator.spawn(pendulumAt("cube", {0, 0, 0})), InputError);
  EXPECT_THROW(simulator.spawn(robot("bad", "<robot", false)), InputError);
  EXPECT_THROW(simulator.spawn(robot("a::b", pendulumUrdf(), true)), InputError);
  EXPECT_THROW(simulator.spawn(pendulumAt("far", {NAN, 0, 0})), InputError);
  EXPECT_THROW(simulator.removeModel("nobody"), InputError);
  EXPECT_EQ(simulator.stateHash(), hash);
}

TEST(Loads, AreSavedAndGainNoEnergyOutOfNothing) {
  Simulator simulator(cubeOn(), model::UriResolver());
  const LinkPart link = findLink(simulator, "cube::link", "test");
  simulator.applyLoad({link.body, {Vector3(0, 3, 20), Vector3(0, 0, 0.1)}, Vector3(0.01, 0.02, 0)}, {0, -1});
  stepFor(&simulator, 0.05);
  const SimulationState state = simulator.save();
  std::uint32_t status = 0;
  for (int i = 0; i < 300; ++i) status |= simulator.step().status;
  EXPECT_EQ(status & ENERGY_GAINED, 0u);
  const std::uint64_t end = simulator.stateHash();
  simulator.clearLoads(link.body);
  EXPECT_NE(simulator.stateHash(), end);
  simulator.restore(state);
  stepFor(&simulator, 0.3);
  EXPECT_EQ(simulator.stateHash(), end);
  EXPECT_GT(bodyOf(simulator, "cube").X_WB.translation().z(), 0.5);
}

TEST(Loads, HaveABound) {
  Simulator simulator(cubeOn(), model::UriResolver());
  simulator.spawn(pendulumAt("guest", {3, 0, 0}));
  for (int i = 0; i < 10000; ++i) simulator.applyEffort(0, 1e-6, {0, 0.5});
  EXPECT_THROW(simulator.applyEffort(0, 1e-6, {0, 0.5}), InputError);
  stepFor(&simulator, 0.6);
  EXPECT_NO_THROW(simulator.applyEffort(0, 1e-6, {0, 0.5}));
}

/** A pendulum whose centre of mass was moved later moves as one that had it from the start. */
TEST(LinkProperties, ComOfALinkOnAJointIsMoved) {
  for (const char* stepper : {"articulated", "world_step"}) {
    SimulationConfig config;
    config.solver.stepper = stepper;
    config.robots = {pendulumAt("swing", Vector3::Zero())};
    Simulator moved(config, model::UriResolver());
    std::string& urdf = config.robots[0].urdf_xml;
    urdf.replace(urdf.find("0.5 0 0"), 7, "0.3 0 0.1");
    Simulator made(config, model::UriResolver());
    const LinkPart arm = findLink(moved, "arm", "test");
    geometry::MassProperties inertial = moved.linkInertial(arm.body, arm.link);
    inertial.com = Vector3(0.3, 0, 0.1);
    stepFor(&moved, 0.001);
    moved.setLinkInertial(arm.body, arm.link, inertial);
    moved.resetWorld();
    stepFor(&moved, 0.3);
    stepFor(&made, 0.3);
    EXPECT_NEAR(moved.report().joints[0].position, made.report().joints[0].position, 1e-9) << stepper;
    EXPECT_GT(std::abs(made.report().joints[0].position), 0.1);
  }
}

TEST(LinkProperties, AbsurdOnesAreRefusedAndChangeNothing) {
  SimulationConfig config;
  config.robots = {pendulumAt("swing", Vector3::Zero())};
  Simulator simulator(config, model::UriResolver());
  const LinkPart arm = findLink(simulator, "arm", "test");
  const geometry::MassProperties good = simulator.linkInertial(arm.body, arm.link);
  const std::uint64_t hash = simulator.stateHash();
  for (int i = 0; i < 4; ++i) {
    geometry::MassProperties absurd = good;
    if (i == 0) absurd.mass = 1.8e-317;
    if (i == 1) absurd.mass = 1e300;
    if (i == 2) absurd.inertia = 1e-310 * Matrix3::Identity();
    if (i == 3) absurd.inertia(2, 2) = NAN;
    EXPECT_THROW(simulator.setLinkInertial(arm.body, arm.link, absurd), InputError) << i;
    EXPECT_EQ(simulator.stateHash(), hash) << i;
    EXPECT_EQ(simulator.linkInertial(arm.body, arm.link).mass, good.mass) << i;
  }
}

}  // namespace
}  // namespace blem_sim::sim
