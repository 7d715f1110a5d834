// Heaps with a robot in their midst: a paddle that lies below cubes in a bin, turned by a motor that their weight takes to its bound.
#pragma once

#include <string>

#include "soak/heap.h"

namespace blem_sim {

/** A paddle that turns about the vertical, 60 N m at most, and at its end a flap on a hinge with friction, held by 2 N m. */
inline std::string stirrerUrdf() {
  const auto link = [](const std::string& name, const std::string& size, double mass, double x) {
    const std::string origin = "<origin xyz=\"" + std::to_string(x) + " 0 0\"/>";
    return "<link name=\"" + name + "\"><inertial>" + origin + "<mass value=\"" + std::to_string(mass) +
           "\"/><inertia ixx=\"0.01\" iyy=\"0.02\" izz=\"0.02\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision>" + origin +
           "<geometry><box size=\"" + size + "\"/></geometry></collision></link>";
  };
  return "<robot name=\"stirrer\"><link name=\"base\"/>" + link("paddle", "0.5 0.05 0.05", 2, 0) +
         link("flap", "0.1 0.03 0.05", 0.2, 0.05) +
         R"(<joint name="turn" type="revolute"><parent link="base"/><child link="paddle"/><origin xyz="0 0 0.06"/><axis xyz="0 0 1"/>
              <limit lower="-10" upper="10" effort="60" velocity="3"/></joint>
            <joint name="hinge" type="revolute"><parent link="paddle"/><child link="flap"/><origin xyz="0.26 0 0"/><axis xyz="0 0 1"/>
              <limit lower="-1" upper="1" effort="2" velocity="10"/><dynamics friction="0.2"/></joint></robot>)";
}

/** Cubes of 0.1 m and 1 kg over a stirrer in a bin. Its joint "turn" is robot 0's; the motors know velocities and positions. */
inline sim::SimulationConfig stirredHeap(int cubes, int seed, const dynamics::SolverSettings& solver) {
  sim::SimulationConfig config = heapInBin(cubes, seed, solver);
  config.robots = {sim::robot("stirrer", stirrerUrdf(), true)};
  config.robots[0].gains["default"] = {2000, 0, 100, 0};
  return config;
}

/** Turns the paddle to and fro by 2 rad, once in two seconds. */
inline void stir(sim::Simulator* simulator) {
  simulator->commandJoints(0, {{"turn", "hinge"}, {2 * std::sin(M_PI * simulator->report().time), 0}, {}, {}});
}

}  // namespace blem_sim
