// Followers on cams and screws: their contacts bear in every step, along the normal of what they ride on, though it turns away from them.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double FILM = 0.0005, CAM_RADIUS = 0.03, OFFSET = 0.01, PLATE_MASS = 0.5;  // [m], [m], [m], [kg]

/** A cam, a ball or a cylinder, that turns about y beside its middle, and a plate that slides along z on it. */
std::string camUrdf(const std::string& cam) {
  return fmt::format(
      R"(<robot name="cam"><link name="base"/>
    <link name="cam"><inertial><origin xyz="{0} 0 0"/><mass value="1"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><origin xyz="{0} 0 0" rpy="1.5707963267948966 0 0"/><geometry>{1}</geometry></collision></link>
    <link name="plate"><inertial><mass value="{2}"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><origin xyz="0 0 0.005"/><geometry><box size="0.1 0.015 0.01"/></geometry></collision></link>
    <joint name="turn" type="continuous"><parent link="base"/><child link="cam"/><axis xyz="0 -1 0"/></joint>
    <joint name="slide" type="prismatic"><parent link="base"/><child link="plate"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="1" effort="1000" velocity="100"/></joint></robot>)",
      OFFSET, cam, PLATE_MASS);
}

/** Largest miss [N] of the force on the plate, which is m (g - r w^2 sin), from the tenth of a second on. */
double missOf(const std::string& cam, double speed, double dt) {
  SimulationConfig config;
  config.time_step = dt;
  config.contact.boundary_width = FILM;
  config.contact.surface.friction = 0;
  config.robots = {robot("cam", camUrdf(cam), true)};
  config.robots[0].self_collision = true;
  config.robots[0].initial_positions["slide"] = CAM_RADIUS + FILM;
  config.robots[0].gains["turn"] = {0, 0, 50};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"turn"}, {}, {speed}, {}});
  double miss = 0;
  while (simulator.time() < 0.1 + 2 * M_PI / speed) {
    const double angle = simulator.report().joints[simulator.robots()[0].joints[0]].position;
    double force = 0;
    for (const ContactReport& contact : simulator.step().contacts) force += std::abs(contact.force.z());
    if (simulator.time() > 0.1) miss = std::max(miss, std::abs(force - PLATE_MASS * (G - OFFSET * speed * speed * std::sin(angle))));
  }
  return miss;
}

TEST(Cam, BearsItsFollowerInEveryStep) {
  for (const std::string& cam :
       {fmt::format(R"(<cylinder radius="{}" length="0.02"/>)", CAM_RADIUS), fmt::format(R"(<sphere radius="{}"/>)", CAM_RADIUS)}) {
    EXPECT_LT(missOf(cam, 5, 0.001), 0.002) << cam;
    EXPECT_LT(missOf(cam, 15, 0.001), 0.02) << cam;
    EXPECT_LT(missOf(cam, 25, 0.001), 0.2) << cam;
    EXPECT_LT(missOf(cam, 3, 0.005), 0.02) << cam;
  }
}

constexpr double LEAD = 0.06, ARM = 0.05, TIP = 0.004;  // [m] of the screw, of its ramp from the axis, of the ball on it

/** A ramp of 1 mm that winds twice about z. */
geometry::TriangleMesh ramp() {
  constexpr int A_TURN = 360;
  geometry::TriangleMesh mesh;
  for (int i = 0; i <= 2 * A_TURN; ++i)
    for (const double radius : {ARM - 0.0005, ARM + 0.0005}) {
      const double angle = 2 * M_PI * i / A_TURN;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), LEAD * i / A_TURN);
      const int v = 2 * i;
      if (radius > ARM && i < 2 * A_TURN) mesh.elements.insert(mesh.elements.end(), {{v, v + 1, v + 3}, {v, v + 3, v + 2}});
    }
  return mesh;
}

/** A motor turns the ramp, and a ball of 1 kg slides along z on it. */
std::string screwUrdf() {
  return fmt::format(R"(<robot name="screw"><link name="base"/>
    <link name="screw"><inertial><mass value="1"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><geometry><mesh filename="file://{}"/></geometry></collision></link>
    <link name="ball"><inertial><mass value="1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><geometry><sphere radius="{}"/></geometry></collision></link>
    <joint name="turn" type="continuous"><parent link="base"/><child link="screw"/><axis xyz="0 0 -1"/></joint>
    <joint name="rise" type="prismatic"><parent link="base"/><child link="ball"/><origin xyz="{} 0 0"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="1" effort="1000" velocity="100"/></joint></robot>)",
                     meshFile("ramp", ramp()), TIP, ARM);
}

/** What lifts the ball is m g r tan(slope + angle of friction), not what the ramp's border would ask for. */
TEST(Screw, LiftsWhatRidesOnItByItsSlopeAndFriction) {
  SimulationConfig config;
  config.contact.boundary_width = 0.0002;
  config.contact.surface.friction = 0.1;
  config.robots = {robot("screw", screwUrdf(), true)};
  const double slope = std::atan(LEAD / (2 * M_PI * ARM));
  config.robots[0].self_collision = true;
  config.robots[0].initial_positions["rise"] = LEAD / 4 + TIP / std::cos(slope) + 0.0005;
  config.robots[0].initial_positions["turn"] = M_PI / 2;
  config.robots[0].gains["turn"] = {0, 0, 50};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"turn"}, {}, {10}, {}});
  stepFor(&simulator, 0.1);
  double torque = 0;
  for (int i = 0; i < 500; ++i) torque += simulator.step().joints[simulator.robots()[0].joints[0]].effort / 500;
  EXPECT_NEAR(torque, G * ARM * std::tan(slope + std::atan(0.1)), 0.002);
}

}  // namespace
}  // namespace blem_sim::sim
