// Budgets are a wish: a body that stands on many others, or carries many, never falls through.
#include <algorithm>
#include <cmath>

#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double SIDE = 0.1, PITCH = 0.13, THICK = 0.05, TRAY_LAYER = 0.0025;

double sideOf(int rows) { return PITCH * rows; }

/** rows x rows cubes in a grid about the origin, resting on a surface with a layer at this height. */
void addCubes(int rows, double top, double mass, SimulationConfig* config) {
  for (int i = 0; i < rows * rows; ++i) {
    const double x = PITCH * (i / rows - 0.5 * (rows - 1)), y = PITCH * (i % rows - 0.5 * (rows - 1));
    config->objects.push_back(box("cube" + std::to_string(i), Vector3::Constant(SIDE), mass, {x, y, top + 2 * TRAY_LAYER + 0.5 * SIDE}));
  }
}

SimulationConfig loadedPallet(int rows) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("pallet", {sideOf(rows), sideOf(rows), THICK}, 20, {0, 0, 0.5 * THICK + TRAY_LAYER})};
  addCubes(rows, THICK + TRAY_LAYER, 1, &config);
  return config;
}

std::string liftUrdf(double side) {
  const std::string size = std::to_string(side) + " " + std::to_string(side) + " " + std::to_string(THICK);
  return R"(<robot name="lift"><link name="base"/>
  <link name="tray"><inertial><mass value="5"/><inertia ixx="0.5" iyy="0.5" izz="0.5" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size=")" +
         size + R"("/></geometry></collision></link>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="tray"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1e5" velocity="10"/></joint></robot>)";
}

SimulationConfig loadedTray(int rows) {
  SimulationConfig config;
  config.robots = {robot("lift", liftUrdf(sideOf(rows)), true)};
  config.robots[0].X_WR = makePose({0, 0, 1});
  config.robots[0].gains["default"] = {1e6, 0, 1e4};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  addCubes(rows, 1 + 0.5 * THICK, 0.1, &config);
  return config;
}

struct Carried {
  int fallen = 0;
  double farthest = 0;  ///< [m] of a cube from its first place on its carrier
  double tilt = 0;      ///< [rad]
  double speed = 0;     ///< [m/s] of the fastest cube
};

/** @param moved [m] rise of the carrier */
Carried cubesOf(const Simulator& simulator, const SimulationConfig& config, double moved) {
  Carried carried;
  for (const ObjectConfig& object : config.objects) {
    const dynamics::BodyState state = bodyOf(simulator, object.name);
    const Vector3 off = state.X_WB.translation() - object.X_WO.translation() - Vector3(0, 0, moved);
    carried.fallen += off.z() < -0.01;
    carried.farthest = std::max(carried.farthest, off.norm());
    carried.tilt = std::max(carried.tilt, std::acos(std::min(1.0, state.X_WB.linear()(2, 2))));
    carried.speed = std::max(carried.speed, state.v_WCom.norm());
  }
  return carried;
}

TEST(ContactBudget, APalletCarriesMoreThanItsBudgetHasContacts) {
  for (const int rows : SANITIZED ? std::vector<int>{5} : std::vector<int>{4, 5, 7}) {
    const SimulationConfig config = loadedPallet(rows);
    Simulator simulator(config, model::UriResolver());
    stepFor(&simulator, SANITIZED ? 0.1 : 1);
    const Carried carried = cubesOf(simulator, config, 0);
    EXPECT_EQ(carried.fallen, 0) << rows;
    EXPECT_LT(carried.farthest, 5e-5) << rows;
    EXPECT_LT(carried.tilt, 1e-4) << rows;
    EXPECT_GE(simulator.report().reduced_contacts, 3 * (rows * rows + 1));
    EXPECT_TRUE(simulator.report().status & CONTACTS_REDUCED);
    EXPECT_GT(simulator.report().wrench_error, 0.1);
    EXPECT_LT(simulator.report().wrench_error, 1.5);
  }
}

TEST(ContactBudget, ATrayOfAHundredIsLifted) {
  const int rows = SANITIZED ? 6 : 10;
  constexpr double LIFT = 0.2;
  const SimulationConfig config = loadedTray(rows);
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.1);
  JointTrajectory trajectory;
  trajectory.joints = {"lift"};
  trajectory.points = {{0.5, {LIFT}, {0}, {0}, {}}};
  simulator.commandTrajectory(0, trajectory);
  stepFor(&simulator, 0.9);
  const Carried carried = cubesOf(simulator, config, simulator.report().joints[0].position);
  EXPECT_NEAR(simulator.report().joints[0].position, LIFT, 1e-3);
  EXPECT_EQ(carried.fallen, 0);
  EXPECT_LT(carried.farthest, 1e-4);
  EXPECT_GE(simulator.report().reduced_contacts, 3 * rows * rows);
}

// Four cubes and the ground make twenty contacts.
TEST(ContactBudget, WithinBudgetsNothingIsSaid) {
  const SimulationConfig config = loadedPallet(2);
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.1);
  EXPECT_FALSE(simulator.report().status & CONTACTS_REDUCED);
  EXPECT_EQ(simulator.report().wrench_error, 0);
  EXPECT_EQ(simulator.report().reduced_contacts, 20);
}

}  // namespace
}  // namespace blem_sim::sim
