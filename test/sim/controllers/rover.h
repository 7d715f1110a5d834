// A robot on two driven wheels and a ball.
#pragma once

#include <string>

#include "sim/controllers/wheeled_scene.h"

namespace blem_sim::sim {

constexpr double ROVER_WHEEL = 0.1, ROVER_SEPARATION = 0.4, ROVER_WHEEL_INERTIA = 0.002;  // [m], [kg m^2] about the axle

/** A URDF of a robot whose x is ahead; its wheels are balls, which roll on one point, and its base is on the height of the axle. */
inline std::string roverUrdf(const std::string& blocks = "") {
  const auto ball = [](const std::string& name, double mass, double inertia, double radius) {
    return fmt::format(
        R"(<link name="{0}"><inertial><mass value="{1}"/><inertia ixx="{2}" iyy="{2}" izz="{2}" ixy="0" ixz="0" iyz="0"/></inertial>)"
        R"(<collision><geometry><sphere radius="{3}"/></geometry></collision></link>)",
        name, mass, inertia, radius);
  };
  std::string urdf = R"(<robot name="rover"><link name="base_link"><inertial><origin xyz="-0.05 0 0"/><mass value="6"/>
    <inertia ixx="0.05" iyy="0.05" izz="0.08" ixy="0" ixz="0" iyz="0"/></inertial></link>)";
  for (const char* side : {"left", "right"})
    urdf += ball(fmt::format("{}_wheel", side), 0.5, ROVER_WHEEL_INERTIA, ROVER_WHEEL) +
            fmt::format(R"(<joint name="{0}_axle" type="continuous"><parent link="base_link"/><child link="{0}_wheel"/>
              <origin xyz="0 {1} 0"/><axis xyz="0 1 0"/></joint>)",
                        side, (side == std::string("left") ? 0.5 : -0.5) * ROVER_SEPARATION);
  urdf += ball("caster", 0.1, 1e-4, 0.05) + R"(<joint name="mount" type="fixed"><parent link="base_link"/><child link="caster"/>
    <origin xyz="-0.2 0 -0.05"/></joint>)";
  return urdf + blocks + "</robot>";
}

/** It stands on a plane, its wheels hold by friction 1, its ball slides. */
inline SimulationConfig roverScene(const std::string& blocks = "") {
  SimulationConfig config = wheeledScene(robot("rover", roverUrdf(blocks), false), ROVER_WHEEL);
  config.robots[0].links["caster"].friction = 0.0;
  return config;
}

}  // namespace blem_sim::sim
