// A robot without wheels that is pushed over the ground: its way, its force, what it leaves alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "blem_sim/sim/drive_controller.h"
#include "blem_sim/sim/state_file.h"
#include "sim/simulation_scene.h"
#include "support/input_errors.h"
#include "support/input_notes.h"

namespace blem_sim::sim {
namespace {

constexpr double SLEDGE_MASS = 20, SLEDGE_LENGTH = 0.6, SLEDGE_WIDTH = 0.4, SLEDGE_HEIGHT = 0.2;  // [kg], [m]
constexpr double SLEDGE_FRICTION = 0.5, SLEDGE_WEIGHT = SLEDGE_MASS * G;

/** A box whose centre of mass is off its middle, and a mast on a hinge that its motor holds. */
std::string sledgeUrdf() {
  return fmt::format(
      R"(<robot name="sledge"><link name="base_footprint"/>
        <joint name="up" type="fixed"><parent link="base_footprint"/><child link="hull"/><origin xyz="0 0 {0}"/></joint>
        <link name="hull"><inertial><origin xyz="0.05 0 0"/><mass value="{1}"/><inertia ixx="0.4" iyy="0.7" izz="0.9" ixy="0" ixz="0" iyz="0"/></inertial>
          <collision><geometry><box size="{2} {3} {4}"/></geometry></collision></link>
        <joint name="hinge" type="revolute"><parent link="hull"/><child link="mast"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/>
          <limit lower="-1" upper="1" effort="200" velocity="10"/></joint>
        <link name="mast"><inertial><origin xyz="0 0 0.2"/><mass value="{5}"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
      </robot>)",
      0.5 * SLEDGE_HEIGHT, 0.9 * SLEDGE_MASS, SLEDGE_LENGTH, SLEDGE_WIDTH, SLEDGE_HEIGHT, 0.1 * SLEDGE_MASS);
}

SimulationConfig sledgeScene() {
  SimulationConfig config;
  EnvironmentConfig plane;
  plane.name = "plane";
  plane.plane = Eigen::Vector4d(0, 0, 1, 0);
  config.environments = {plane};
  config.contact.surface.friction = SLEDGE_FRICTION;
  config.robots = {robot("sledge", sledgeUrdf(), false)};
  config.robots[0].motors = MotorDefault::COMPUTED;
  config.robots[0].contact.shrink = true;
  return config;
}

ControllerConfig planarDrive(double max_force = 0) {
  ControllerConfig config;
  config.name = "drive";
  config.kind = ControllerKind::PLANAR_DRIVE;
  config.drive.source = DriveConfig::Odometry::WORLD;
  config.drive.base_frame = "base_footprint";
  config.drive.cmd_vel_timeout = 0;
  config.drive.max_force = max_force;
  return config;
}

/** A sledge with its drive. */
struct Sledge {
  explicit Sledge(SimulationConfig scene = sledgeScene(), const ControllerConfig& config = planarDrive())
      : simulator(scene, model::UriResolver()), drive(&simulator, 0, config) {
    drive.start();
  }

  void runFor(double seconds) {
    const long steps = std::lround(seconds / simulator.config().time_step);
    for (long i = 0; i < steps; ++i) {
      statuses |= simulator.step().status;
      drive.update();
    }
  }
  DriveOdometry odometry() const { return drive.odometry(); }
  Vector3 place() const { return odometry().X_OB.translation(); }
  double heading() const { return std::atan2(odometry().X_OB.linear()(1, 0), odometry().X_OB.linear()(0, 0)); }

  Simulator simulator;
  DriveController drive;
  std::uint32_t statuses = 0;
};

TEST(PlanarDrive, FollowsATwistOnAnArcAgainstFriction) {
  Sledge sledge;
  sledge.drive.command({0.3, 0.5, 0.2});
  sledge.runFor(0.5);
  const Vector3 start = sledge.place();
  const double from = sledge.heading();
  constexpr double TIME = 4, TURN = 0.5;
  sledge.runFor(TIME);
  EXPECT_NEAR(std::remainder(sledge.heading() - from - TURN * TIME, 2 * M_PI), 0, 1e-6);
  // The place turns about a point beside it.
  const auto middle = [&](double heading, const Vector3& at) -> Vector3 {
    return at + Eigen::AngleAxisd(heading, Vector3::UnitZ()) * Vector3(-0.2, 0.3, 0) / TURN;
  };
  EXPECT_NEAR((middle(sledge.heading(), sledge.place()) - middle(from, start)).norm(), 0, 1e-5);
  EXPECT_NEAR(sledge.odometry().v_OB.x(), 0.3, 2e-4);
  EXPECT_NEAR(sledge.odometry().v_OB.y(), 0.2, 2e-4);
  EXPECT_NEAR(sledge.odometry().w_OB.z(), TURN, 1e-6);
  EXPECT_EQ(sledge.statuses & ~(EFFORT_SATURATED | CONTACTS_REDUCED), 0u);
}

TEST(PlanarDrive, StandsStillWithoutACommand) {
  Sledge sledge;
  sledge.runFor(0.2);
  const Vector3 place = sledge.place();
  sledge.runFor(1);
  EXPECT_LT((sledge.place() - place).norm(), 1e-7);
}

TEST(PlanarDrive, SpeedsUpByWhatItsForceLeavesOfFriction) {
  Sledge weak(sledgeScene(), planarDrive(0.3 * SLEDGE_WEIGHT));
  weak.drive.command({1, 0});
  weak.runFor(0.5);
  EXPECT_LT(weak.place().head<2>().norm(), 1e-5) << "friction holds it";
  Sledge strong(sledgeScene(), planarDrive(0.7 * SLEDGE_WEIGHT));
  strong.runFor(0.1);
  strong.drive.command({1, 0});
  const double before = strong.odometry().v_OB.x();
  strong.runFor(0.2);
  EXPECT_NEAR((strong.odometry().v_OB.x() - before) / 0.2, (0.7 - SLEDGE_FRICTION) * G, 0.02);
  EXPECT_NE(strong.statuses & EFFORT_SATURATED, 0u);
}

SimulationConfig sledgeAtWall(double friction) {
  SimulationConfig config = sledgeScene();
  config.contact.surface.friction = friction;
  EnvironmentConfig wall;
  wall.name = "wall";
  wall.plane = Eigen::Vector4d(-1, 0, 0, -1);
  config.environments.push_back(wall);
  return config;
}

TEST(PlanarDrive, StopsAtAWallThatItPushesWithItsForce) {
  constexpr double FORCE = 0.4 * SLEDGE_WEIGHT;
  Sledge sledge(sledgeAtWall(0), planarDrive(FORCE));
  sledge.drive.command({0.5, 0});
  sledge.runFor(4);
  EXPECT_NEAR(sledge.place().x(), 1 - 0.5 * SLEDGE_LENGTH, 2e-3);
  EXPECT_LT(sledge.odometry().v_OB.norm(), 1e-4);
  EXPECT_NEAR(-forceOfWorld(sledge.simulator.report()).x(), FORCE, 1e-3 * FORCE);
  EXPECT_EQ(sledge.statuses & (ENERGY_GAINED | CONTACT_UNRELIABLE | SOLVER_TROUBLE), 0u);
  sledge.drive.command({-0.5, 0});
  sledge.runFor(1);
  EXPECT_NEAR(sledge.odometry().v_OB.x(), -0.5, 1e-6);
}

TEST(PlanarDrive, FallsAndTiltsAsItWouldAlone) {
  SimulationConfig config = sledgeScene();
  config.environments.clear();
  Sledge sledge(config);
  sledge.drive.command({0.5, 0.4});
  sledge.simulator.applyLoad({sledge.simulator.robots()[0].bodies[0], {Vector3::Zero(), {1, 0, 0}}, Vector3::Zero()}, {0, 0.1});
  sledge.runFor(0.5);
  EXPECT_NEAR(sledge.odometry().v_OB.norm(), std::hypot(0.5, G * 0.5), 0.02);
  EXPECT_GT(std::acos(sledge.odometry().X_OB.linear()(2, 2)), 0.05);
  EXPECT_EQ(sledge.statuses & ENERGY_GAINED, 0u);
}

TEST(PlanarDrive, TwistsChangeWithinTheirLimitsAndEnd) {
  ControllerConfig config = planarDrive();
  config.drive.lateral.max_acceleration = 0.5;
  config.drive.lateral.min_acceleration = -0.5;
  config.drive.lateral.max_velocity = 0.2;
  config.drive.cmd_vel_timeout = 0.5;
  Sledge sledge(sledgeScene(), config);
  sledge.runFor(0.1);
  sledge.drive.command({0, 0, 1});
  sledge.runFor(0.2);
  EXPECT_NEAR(sledge.odometry().v_OB.y(), 0.1, 1e-3);
  sledge.runFor(0.3);
  EXPECT_NEAR(sledge.odometry().v_OB.y(), 0.2, 1e-5);
  sledge.runFor(0.5);
  EXPECT_NEAR(sledge.odometry().v_OB.y(), 0, 1e-5);
}

TEST(PlanarDrive, GoesOnFromASavedStateAndEndsWithAReset) {
  Sledge sledge;
  sledge.drive.command({0.3, 0.2, 0.1});
  sledge.runFor(0.3);
  const SimulationState state = stateOf(stateBytes(sledge.simulator.save()), "bytes");
  sledge.runFor(0.5);
  const std::uint64_t hash = sledge.simulator.stateHash();
  sledge.simulator.restore(state);
  sledge.drive.update();
  sledge.runFor(0.5);
  EXPECT_EQ(sledge.simulator.stateHash(), hash);
  Simulator fresh(sledgeScene(), model::UriResolver());
  fresh.restore(state);
  stepFor(&fresh, 0.5);
  EXPECT_EQ(fresh.stateHash(), hash) << "the command is part of the state";
  sledge.simulator.resetWorld();
  sledge.runFor(0.5);
  EXPECT_LT(sledge.place().head<2>().norm(), 1e-6);
}

TEST(PlanarDrive, LeavesTheBaseFreeWhenItStops) {
  Sledge sledge;
  sledge.runFor(0.1);
  EXPECT_NE(sledge.simulator.baseCommand(0), nullptr);
  sledge.drive.stop();
  EXPECT_EQ(sledge.simulator.baseCommand(0), nullptr);
  EXPECT_TRUE(isOneLineWith(refusal([&] { sledge.drive.command({0.1, 0}); }), {"drive", "stopped"}));
}

TEST(PlanarDrive, OfAPluginIsLeftOutWhereTheBaseIsFixed) {
  SimulationConfig config = sledgeScene();
  std::string& urdf = config.robots[0].urdf_xml;
  urdf.insert(urdf.rfind("</robot>"), R"(<gazebo><plugin name="push" filename="libgazebo_ros_planar_move.so"/></gazebo>)");
  EXPECT_EQ(Simulator(config, model::UriResolver()).robots()[0].drives.size(), 1u);
  config.robots[0].fixed_base = true;
  const Simulator held(config, model::UriResolver());
  EXPECT_TRUE(held.robots()[0].drives.empty());
  const auto told = [](const std::string& note) { return note.find("sledge: plugin 'push': the base is fixed") == 0; };
  EXPECT_EQ(std::count_if(held.notes().begin(), held.notes().end(), told), 1);
}

TEST(PlanarDrive, RefusesWhatItCannotMove) {
  const auto told = [](const SimulationConfig& config) { return refusal([&] { Sledge sledge(config); }); };
  SimulationConfig config = sledgeScene();
  config.robots[0].fixed_base = true;
  EXPECT_TRUE(isOneLineWith(told(config), {"sledge", "fixed"}));
  config = sledgeScene();
  config.solver.stepper = "quick_step";
  EXPECT_TRUE(isOneLineWith(told(config), {"quick_step", "solver.stepper", "articulated"}));
  Sledge sledge;
  EXPECT_TRUE(isOneLineWith(refusal([&] { sledge.drive.command({0, 0, NAN}); }), {"linear.y", "finite"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { sledge.simulator.driveBase(0, 9, {}); }), {"no link 9"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { sledge.simulator.driveBase(0, 0, {0, 0, 0, -1, 0}); }), {"below 0"}));
}

}  // namespace
}  // namespace blem_sim::sim
